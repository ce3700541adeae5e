# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
The same trees on the page and as files in other renderers, on one sheet.

    python test/page/take_renderers.py doc/pictures/gallery/renderers.jpg --blender bpy/bin/python

Rows are trees; columns are the page, glTF in three.js (``npm install`` in the root), glTF
in Blender and USD in Blender.

"""

from __future__ import annotations

import argparse
import asyncio
import io
from pathlib import Path
import shutil
import subprocess
import tempfile

from aiohttp import web
from PIL import Image
from take_gallery import GROWN, take, View
from tree_sway_lab.browser import Browser

from tree_sway.commands import cli

HERE = Path(__file__).parent
MODULES = HERE.parents[1] / 'node_modules'
TREES = 'oak', 'birch'
SIZE = 480
_THREE = """<!doctype html><html><body style="margin:0"><script type="importmap">
{"imports": {"three": "/three/build/three.module.js"}}</script><script type="module">
import * as THREE from "three";
import { GLTFLoader } from "/three/examples/jsm/loaders/GLTFLoader.js";
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(innerWidth, innerHeight);
document.body.append(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0xb9d0e6);
new GLTFLoader().load("/tree.glb", ({ scene: tree, animations }) => {
  scene.add(tree);
  const mixer = new THREE.AnimationMixer(tree);
  for (const each of animations) mixer.clipAction(each).play();
  mixer.setTime(2);
  tree.updateMatrixWorld(true);
  const box = new THREE.Box3().setFromObject(tree, true);
  const [size, middle] = [box.getSize(new THREE.Vector3()), box.getCenter(new THREE.Vector3())];
  const far = 2.2 * Math.max(size.x, size.y, size.z);
  const camera = new THREE.PerspectiveCamera(36, 1, 0.1, 1000);
  const [x, z] = [middle.x + far * Math.cos(-0.6), middle.z - far * Math.sin(-0.6)];
  camera.position.set(x, box.min.y + 0.35 * size.y, z);
  camera.lookAt(middle);
  const sun = new THREE.DirectionalLight(0xffffff, 3);
  sun.position.copy(middle).add(new THREE.Vector3(0.7, 0.648, -0.3).multiplyScalar(far));
  sun.target.position.copy(middle);
  sun.castShadow = renderer.shadowMap.enabled = true;
  sun.shadow.mapSize.set(2048, 2048);
  const { camera: seen } = sun.shadow;
  [seen.left, seen.right, seen.bottom, seen.top] = [-1, 1, -1, 1].map((way) => (way * far) / 3);
  seen.far = 2 * far;
  tree.traverse((each) => (each.castShadow = true));
  const green = new THREE.MeshLambertMaterial({ color: 0x5f6b33 });
  const lawn = new THREE.Mesh(new THREE.CircleGeometry(200, 64), green);
  lawn.rotation.x = -Math.PI / 2;
  lawn.receiveShadow = true;
  scene.add(sun, sun.target, new THREE.HemisphereLight(0xdde8ff, 0x6b7a4d, 2.6), lawn);
  renderer.render(scene, camera);
  window.isDone = true;
});
</script></body></html>"""


def main() -> None:
    """Take every picture, and put them on a sheet."""
    parser = argparse.ArgumentParser()
    parser.add_argument('sheet', type=Path)
    parser.add_argument('--blender', help='a Python that has bpy; without it Blender is left out')
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = [_row(key, Path(folder), given.blender) for key in TREES]
    sheet = Image.new('RGB', (SIZE * len(rows[0]), SIZE * len(rows)))
    for j, row in enumerate(rows):
        for i, picture in enumerate(row):
            sheet.paste(
                picture.resize((SIZE, SIZE), Image.Resampling.LANCZOS), (SIZE * i, SIZE * j)
            )
    sheet.save(given.sheet, quality=85, optimize=True)
    print(given.sheet, given.sheet.stat().st_size)


def _row(key: str, folder: Path, blender: str | None) -> list[Image.Image]:
    """Return the pictures of one tree."""
    tree = folder / f'{key}.yaml'
    cli.main(['grow', '--species', key, *GROWN[key].split(), '-o', str(tree)])
    for suffix in ('.glb', '.usdz'):
        cli.main(['convert', str(tree), '-o', str(tree.with_suffix(suffix))])
    shot = folder / f'{key}.jpg'
    take(View(key, key, size=(2 * SIZE, 2 * SIZE)), str(tree), shot)
    row = [Image.open(shot).convert('RGB'), asyncio.run(_in_three(tree.with_suffix('.glb')))]
    for suffix in ('.glb', '.usdz') if blender else ():
        picture = folder / f'{key}{suffix}.png'
        script = str(HERE / 'render_in_blender.py')
        command = [str(blender), script, str(tree.with_suffix(suffix)), str(picture)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        row.append(Image.open(picture).convert('RGB'))
    return row


async def _in_three(file: Path) -> Image.Image:
    """Draw a glTF with three.js."""
    if not (MODULES / 'three').exists():
        raise SystemExit(
            f'no three.js: run {shutil.which("npm") or "npm"} install in the root of the sources'
        )

    async def page(_: web.Request) -> web.Response:
        return web.Response(text=_THREE, content_type='text/html')

    async def tree(_: web.Request) -> web.FileResponse:
        return web.FileResponse(file)

    app = web.Application()
    app.add_routes([web.get('/', page), web.get('/tree.glb', tree)])
    app.router.add_static('/three', MODULES / 'three')
    runner = web.AppRunner(app)
    await runner.setup()
    await web.TCPSite(runner, '127.0.0.1', 0).start()
    try:
        async with Browser() as browser:
            port = runner.addresses[0][1]
            await browser.open(f'http://127.0.0.1:{port}/', width=2 * SIZE, height=2 * SIZE)
            await browser.until('window.isDone')
            return Image.open(io.BytesIO(await browser.screenshot())).convert('RGB')
    finally:
        await runner.cleanup()


if __name__ == '__main__':
    main()
