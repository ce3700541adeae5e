// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
/** Light, ground and camera, and the stream; the two examples differ in what stands there. */

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { TreeStream } from "../../tree_sway/page/static/client.js";

export class Stage {
  constructor() {
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xe8ecf0);
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    document.body.append(this.renderer.domElement);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 500);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    const sun = new THREE.DirectionalLight(0xffffff, 2.5);
    sun.position.set(3, 6, 2);
    this.scene.add(sun, new THREE.HemisphereLight(0xffffff, 0x667755, 1.5));
    const ground = new THREE.Mesh(
      new THREE.CircleGeometry(20, 48),
      new THREE.MeshLambertMaterial({ color: 0xb9c0ad }),
    );
    ground.rotation.x = -Math.PI / 2;
    this.scene.add(ground);
    addEventListener("resize", () => this.resize());
    this.resize();
  }

  resize() {
    this.camera.aspect = innerWidth / innerHeight;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(innerWidth, innerHeight);
  }

  /** See all of a tree of this height [m]. */
  frame(height) {
    this.controls.target.set(0, height / 2, 0);
    this.camera.position.set(1.3 * height, 0.8 * height, 1.7 * height);
    this.controls.update();
  }

  /** Follow the stream of ?page=; `draw` is called with it before each picture. */
  follow(described, draw) {
    const page = new URLSearchParams(location.search).get("page") ?? "http://127.0.0.1:8765/";
    const told = document.getElementById("state");
    const stream = new TreeStream(page, {
      onState: (state) => (told.textContent = state),
      onDescription: described,
    });
    stream.open();
    this.renderer.setAnimationLoop(() => {
      draw(stream);
      this.renderer.render(this.scene, this.camera);
    });
    return stream;
  }
}
