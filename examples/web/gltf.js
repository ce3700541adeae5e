// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/**
 * A glTF of `tree-sway convert --sway morph`, whose weights are the state of the stream. With ?count=100
 * it is 100 trees of one mesh, each with weights of its own: gusts reach one row after another.
 */

import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Stage } from "./stage.js";

const stage = new Stage();
const file = new URLSearchParams(location.search).get("file") ?? "tree.glb";
const { scene } = await new GLTFLoader().loadAsync(file);
stage.scene.add(scene);
const count = Number(new URLSearchParams(location.search).get("count") ?? 1);
const parts = [];
scene.traverse((part) => part.morphTargetInfluences && parts.push(part));
/** Coordinates at a weight of 1 and in a storm; three.js has the extras of a mesh on its parts. */
const { unit, storm } = (parts[0].userData.unit ? parts[0] : parts[0].parent).userData;

/** Frames by which a row of trees feels a gust later than the row before it. */
const LATER = 8;
const across = Math.ceil(Math.sqrt(count));
/** Weights of the last frames, the newest first. */
const history = [];
let forest = [];

/** As many trees of each part, on a grid. @param {number} spacing [m] */
function plant(spacing) {
  scene.updateMatrixWorld(true);
  forest = parts.map((part) => {
    const trees = new THREE.InstancedMesh(part.geometry, part.material, count);
    trees.morphTargetInfluences = [...part.morphTargetInfluences];
    trees.frustumCulled = false;
    const matrix = new THREE.Matrix4();
    for (let i = 0; i < count; i++) {
      const [row, column] = [Math.floor(i / across), i % across].map((each) => each - (across - 1) / 2);
      trees.setMatrixAt(i, matrix.makeTranslation(spacing * column, 0, spacing * row).multiply(part.matrixWorld));
      trees.setMorphAt(i, part);
    }
    return trees;
  });
  scene.removeFromParent();
  stage.scene.add(...forest);
}

function described(description) {
  const { height } = description.trees[0];
  stage.frame(height * (count > 1 ? 0.6 * across : 1));
  if (count > 1 && !forest.length) plant(0.8 * height);
  const { scale } = description;
  // A description's full scale leaves the same room above every storm.
  const room = scale[0] / storm[0];
  const fits = storm.length === scale.length && storm.every((s, k) => Math.abs(scale[k] / s / room - 1) < 1e-3);
  if (!fits) throw new Error(`${file} is of another tree or model than ${description.name}`);
}

function draw(stream) {
  const coordinates = stream.sample();
  if (!coordinates || coordinates.length !== unit.length) return;
  const weights = Array.from(coordinates, (each, k) => each / unit[k]);
  history.unshift(weights);
  history.length = Math.min(history.length, LATER * across);
  for (const part of parts) part.morphTargetInfluences.splice(0, unit.length, ...weights);
  for (const trees of forest) {
    for (let i = 0; i < count; i++) {
      const late = LATER * Math.floor(i / across);
      trees.setMorphAt(i, { morphTargetInfluences: history[Math.min(late, history.length - 1)] });
    }
    trees.morphTexture.needsUpdate = true;
  }
}

/** For tests and for the curious at the console. */
window.example = {
  stage,
  stream: stage.follow(described, draw),
  tip: () => [...parts[0].morphTargetInfluences],
};
