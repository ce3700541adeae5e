// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** One cylinder per segment, placed by the poses of the stream. */

import * as THREE from "three";
import { STRIDE } from "../../tree_sway/page/static/placing.js";
import { Stage } from "./stage.js";

const stage = new Stage();
// A pose is z up; three.js is y up.
const root = new THREE.Group();
root.rotation.x = -Math.PI / 2;
stage.scene.add(root);

let segments = null;
const at = new THREE.Vector3();
const turn = new THREE.Quaternion();
const size = new THREE.Vector3();
const matrix = new THREE.Matrix4();

function described(description) {
  segments?.removeFromParent();
  // From its root-side end along x, as a pose has it.
  const shape = new THREE.CylinderGeometry(1, 1, 1, 6).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
  const bark = new THREE.MeshLambertMaterial({ color: 0x7a6350 });
  segments = new THREE.InstancedMesh(shape, bark, description.nSegments);
  segments.frustumCulled = false;
  root.add(segments);
  stage.frame(Math.max(...description.trees.map((tree) => tree.height)));
}

function draw(stream) {
  const poses = stream.poses();
  if (!poses || !segments) return;
  const { kinds, trees } = stream.description;
  let row = 0;
  for (const { kind } of trees) {
    const { segment_length: length, segment_radius: radius } = kinds[kind].arrays;
    for (let s = 0; s < length.length; s++, row++) {
      const o = STRIDE * row;
      at.fromArray(poses, o);
      turn.fromArray(poses, o + 4);
      // The fourth number of a pose is the scale of its tree.
      size.set(length[s], radius[2 * s], radius[2 * s]).multiplyScalar(poses[o + 3]);
      segments.setMatrixAt(row, matrix.compose(at, turn, size));
    }
  }
  segments.instanceMatrix.needsUpdate = true;
}

/** For tests and for the curious at the console. */
window.example = {
  stage,
  stream: stage.follow(described, draw),
  /** Where the last segment is drawn. */
  tip() {
    if (!segments) return null;
    segments.getMatrixAt(segments.count - 1, matrix);
    return at.setFromMatrixPosition(matrix).toArray();
  },
};
