// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** The trees of a stream as one object of three.js: a cylinder per segment, placed by the poses of now. */

import * as THREE from "three";
import { STRIDE } from "../../tree_sway/page/static/placing.js";

const at = new THREE.Vector3();
const turn = new THREE.Quaternion();
const size = new THREE.Vector3();
const matrix = new THREE.Matrix4();

export class SwayingTrees extends THREE.Group {
  /** @param {import("../../tree_sway/page/static/client.js").TreeStream} stream open, or to be opened
   * @param {THREE.Material} [bark] */
  constructor(stream, bark = new THREE.MeshLambertMaterial({ color: 0x7a6350 })) {
    super();
    this.stream = stream;
    this.bark = bark;
    this.rotation.x = -Math.PI / 2; // A pose is z up; three.js is y up.
    /** Description whose segments are there. */
    this.described = null;
    /** @type {THREE.InstancedMesh | null} null before the first description */
    this.segments = null;
  }

  /** Move every segment to where it is now; call it before each picture. */
  update() {
    const { description } = this.stream;
    const poses = this.stream.poses();
    if (!poses) return;
    if (this.described !== description) this.#build(description);
    let row = 0;
    for (const { kind } of description.trees) {
      const { segment_length: length, segment_radius: radius } = description.kinds[kind].arrays;
      for (let s = 0; s < length.length; s++, row++) {
        const o = STRIDE * row;
        at.fromArray(poses, o);
        turn.fromArray(poses, o + 4);
        // The fourth number of a pose is the scale of its tree.
        size.set(length[s], radius[2 * s], radius[2 * s]).multiplyScalar(poses[o + 3]);
        this.segments.setMatrixAt(row, matrix.compose(at, turn, size));
      }
    }
    this.segments.instanceMatrix.needsUpdate = true;
  }

  /** Free what is on the graphics card. */
  dispose() {
    this.segments?.removeFromParent();
    this.segments?.geometry.dispose();
    this.segments?.dispose();
    this.described = this.segments = null;
  }

  #build(description) {
    this.dispose();
    // From its root-side end along x, as a pose has it.
    const shape = new THREE.CylinderGeometry(1, 1, 1, 6).rotateZ(-Math.PI / 2).translate(0.5, 0, 0);
    this.segments = new THREE.InstancedMesh(shape, this.bark, description.nSegments);
    this.segments.frustumCulled = false;
    this.add(this.segments);
    this.described = description;
  }
}
