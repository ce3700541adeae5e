// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The trees of a page as cylinders. */

import * as THREE from "three";
import { Stage } from "./stage.js";
import { SwayingTrees } from "./swaying_trees.js";

const stage = new Stage();
let trees = null;

const stream = stage.follow(
  (description) => stage.frame(Math.max(...description.trees.map((tree) => tree.height))),
  () => trees?.update(),
);
trees = new SwayingTrees(stream);
stage.scene.add(trees);

/** For tests and for the curious at the console. */
window.example = {
  stage,
  stream,
  /** Where the last segment is drawn. */
  tip() {
    if (!trees.segments) return null;
    const matrix = new THREE.Matrix4();
    trees.segments.getMatrixAt(trees.segments.count - 1, matrix);
    return new THREE.Vector3().setFromMatrixPosition(matrix).toArray();
  },
};
