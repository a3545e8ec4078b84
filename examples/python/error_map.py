#!/usr/bin/env python3
"""Draws how far a technique is from the exact paths, by Matplotlib (Debian's python3-matplotlib).

    error_map.py [MODEL] [--technique NAME] [--size N] [--out FILE.png]
"""
import argparse

import matplotlib
import numpy as np

import pellucid

matplotlib.use("Agg")  # needs no window
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description="Draw the error of a technique's paths")
parser.add_argument("model", nargs="?", default="shape:knot")
parser.add_argument("--technique", default="wang-2014")
parser.add_argument("--size", type=int, default=256)
parser.add_argument("--out", default="error_map.png")
arguments = parser.parse_args()
size = arguments.size

scene = pellucid.load_scene(arguments.model)
camera = pellucid.framing_camera(scene.bounds, size, size)
renderer = pellucid.Renderer()
renderer.set_scene(scene)
renderer.set_camera(camera)
frame = renderer.render(size, size, arguments.technique, paths=True)
exact = pellucid.Tracer(scene).exact(camera, size, size)
accuracy = pellucid.compare_paths(exact, frame.paths, camera)

figure, (picture, error) = plt.subplots(1, 2, figsize=(10, 4.5), layout="constrained")
picture.imshow(frame.display)
picture.set_title(arguments.technique)
shown = np.ma.masked_less(accuracy["error_deg"], 0.0)  # -1 where no glass is
image = error.imshow(shown, norm="log", vmin=0.01, vmax=180.0, cmap="magma")
figure.colorbar(image, ax=error, label="error of the exit direction, degrees")
error.set_title(f"{100 * accuracy['within_1deg']:.1f}% within 1 degree")
for axes in (picture, error):
    axes.set_axis_off()
figure.savefig(arguments.out, dpi=120)
print(f"{arguments.technique}: {100 * accuracy['within_1deg']:.2f}% of {accuracy['covered']} pixels within 1 degree")
