#!/usr/bin/env python3
"""Makes a small data set of glass by `pellucid dataset`, and draws its refractive flow and normals by Matplotlib.

    small_dataset.py [--images N] [--size N] [--out FOLDER] [--pellucid PROGRAM]
"""
import argparse
import json
import subprocess
from pathlib import Path

import matplotlib
import numpy as np

from pellucid.datasets import Dataset

matplotlib.use("Agg")  # needs no window
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser(description="Make a small data set of glass")
parser.add_argument("--images", type=int, default=4)
parser.add_argument("--size", type=int, default=128)
parser.add_argument("--out", type=Path, default=Path("small_dataset"))
parser.add_argument("--pellucid", default="pellucid")
arguments = parser.parse_args()

arguments.out.mkdir(parents=True, exist_ok=True)
recipe = arguments.out / "recipe.json"
recipe.write_text(json.dumps({"width": arguments.size, "height": arguments.size, "images": arguments.images,
                              "objects": {"sources": ["shape:sphere", "shape:torus"], "ior": [1.3, 1.6]}}))
subprocess.run([arguments.pellucid, "dataset", recipe, "--folder", arguments.out, "--quiet"], check=True)

dataset = Dataset(arguments.out)
figure, axes = plt.subplots(len(dataset), 3, figsize=(9, 3 * len(dataset)), squeeze=False, layout="constrained")
for row, sample in zip(axes, dataset):
    flow = np.linalg.norm(sample["flow"], axis=2)
    row[0].imshow(plt.imread(arguments.out / f"{sample['name']}.png"))
    row[1].imshow(np.ma.masked_where(~sample["flow_valid"], flow), vmax=arguments.size / 2)
    row[2].imshow(0.5 + 0.5 * sample["normal_first"])
    for each, title in zip(row, ("image", "refractive flow, px", "normal")):
        each.set_title(title)
        each.set_axis_off()
figure.savefig(arguments.out / "overview.png", dpi=80)
print(f"{len(dataset)} images in {arguments.out}")
