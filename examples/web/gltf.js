// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** A glTF of `tree-sway convert --sway morph`, whose weights are the state of the stream. */

import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Stage } from "./stage.js";

const stage = new Stage();
const file = new URLSearchParams(location.search).get("file") ?? "tree.glb";
const { scene } = await new GLTFLoader().loadAsync(file);
stage.scene.add(scene);
const parts = [];
scene.traverse((part) => part.morphTargetInfluences && parts.push(part));
/** Coordinates at a weight of 1 and in a storm; three.js has the extras of a mesh on its parts. */
const { unit, storm } = (parts[0].userData.unit ? parts[0] : parts[0].parent).userData;

function described(description) {
  stage.frame(description.trees[0].height);
  const { scale } = description;
  // A description's full scale leaves the same room above every storm.
  const room = scale[0] / storm[0];
  const fits = storm.length === scale.length && storm.every((s, k) => Math.abs(scale[k] / s / room - 1) < 1e-3);
  if (!fits) throw new Error(`${file} is of another tree or model than ${description.name}`);
}

function draw(stream) {
  const coordinates = stream.sample();
  if (!coordinates || coordinates.length !== unit.length) return;
  for (const part of parts) {
    for (let k = 0; k < unit.length; k++) part.morphTargetInfluences[k] = coordinates[k] / unit[k];
  }
}

/** For tests and for the curious at the console. */
window.example = {
  stage,
  stream: stage.follow(described, draw),
  tip: () => [...parts[0].morphTargetInfluences],
};
