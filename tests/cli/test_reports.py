"""Scenes after public bug reports: the right value, or the same picture as a twin that says the same otherwise.

They lie in the folder `reports` of $PELLUCID_TEST_DATA, whose INDEX.md says what each of them is. Two pictures are equal
if at most 0.5% of the pixels differ by more than 0.05 in linear radiance: at silhouettes, and where two contacts of a
scene meet, the last digit of a position decides."""
import math
import os
import sys

import cli
from cli import CliTest
from pictures import read_exr

DATA = os.environ.get("PELLUCID_TEST_DATA", "")
REPORTS = os.path.join(DATA, "reports")

# Each way to draw, and what makes it quiet and quick enough.
WAYS = {"balanced": [], "visibility-cube": [], "path": ["--samples", "16"], "reference": []}

TWINS = [
    ("04-two-materials-split.glb", "04-two-materials-one.glb"),
    ("04-two-materials-twonodes.glb", "04-two-materials-one.glb"),
    ("05-tilt-0.glb", "05-tilt-1e-09.glb"),
    ("06-cup-tinyoverlap.glb", "06-cup-exact.glb"),
    ("06-pool-shortrod.glb", "06-pool-rod.glb"),
    ("13-gap-front-0.0001.glb", "13-gap-front-0.003.glb"),
    ("13-offset-x10000.glb", "13-offset-x1000.glb"),
    ("18-rough-texture-0.8.glb", "18-rough-0.8.glb"),
    ("24-winding-onebad.glb", "24-winding-good.glb"),
    ("25-handle-onemesh.glb", "25-handle-twonodes.glb"),
    ("bodies-overlapping.obj", "bodies-overlapping-as-objects-right.gltf"),
    ("bodies-touching.obj", "bodies-touching-as-objects-right.gltf"),
    ("body-inside-body.obj", "body-inside-body-as-objects-right.gltf"),
]


def differing(a, b):
    """Share of the pixels that differ by more than 0.05."""
    channels = len(a.channels)
    pixels = len(a.pixels) // channels
    return sum(any(abs(a.pixels[i * channels + c] - b.pixels[i * channels + c]) > 0.05 for c in range(channels))
               for i in range(pixels)) / pixels


class Reports(CliTest):
    def draw(self, name, way, *arguments, size="128x128"):
        result = self.render(os.path.join(REPORTS, name), "--technique", way, *WAYS[way], *arguments,
                             output="out.exr", size=size)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_exr(self.read("out.exr"))

    def middle(self, picture):
        at = (picture.height // 2 * picture.width + picture.width // 2) * len(picture.channels)
        values = dict(zip(picture.channels, picture.pixels[at:at + len(picture.channels)]))
        return [values[c] for c in "RGB"]

    def test_twins_are_equal(self):
        for name, twin in TWINS:
            for way in WAYS:
                with self.subTest(name, way=way):
                    self.assertLessEqual(differing(self.draw(name, way), self.draw(twin, way)), 0.005)

    def test_slab_seen_straight_on_absorbs(self):
        """2 m of (.5, .25, 1) per m would leave .368 .607 .135; the file's colours are what the INDEX says."""
        for name in ("05-tilt-0.glb", "05-ortho-box-behind.glb"):
            for way in ("balanced", "visibility-cube", "reference"):
                with self.subTest(name, way=way):
                    for got, right in zip(self.middle(self.draw(name, way, "--environment", "uniform")), ORTHO[way]):
                        self.assertAlmostEqual(got, right, delta=0.01)


# Without what two faces reflect, as the reference draws, and with it.
TRANSMITTED = [0.2704, 0.0976, 0.9616]
ORTHO = {way: TRANSMITTED for way in WAYS}

if __name__ == "__main__":
    if not os.path.isdir(REPORTS):
        print("PELLUCID_TEST_DATA has no folder reports")
        sys.exit(cli.SKIPPED)
    cli.main()
