#!/usr/bin/env python3
"""Renders a model from all sides, with one renderer and one upload.

    turntable.py [MODEL] [--frames N] [--size WxH] [--out FOLDER]
"""
import argparse
from pathlib import Path

import pellucid

parser = argparse.ArgumentParser(description="Render a model from all sides")
parser.add_argument("model", nargs="?", default="shape:goblet")
parser.add_argument("--frames", type=int, default=36)
parser.add_argument("--size", default="512x512")
parser.add_argument("--out", type=Path, default=Path("turntable"))
arguments = parser.parse_args()
width, height = map(int, arguments.size.split("x"))
arguments.out.mkdir(parents=True, exist_ok=True)

scene = pellucid.load_scene(arguments.model)
renderer = pellucid.Renderer()
renderer.set_scene(scene)
renderer.set_environment("studio")
for i in range(arguments.frames):
    renderer.set_camera(pellucid.orbit_camera(scene.bounds, 360.0 * i / arguments.frames, 15.0, 5.0))
    frame = renderer.render(width, height)
    pellucid.write_image(arguments.out / f"{i:03}.png", frame.display)
print(f"{arguments.frames} frames in {arguments.out}")
