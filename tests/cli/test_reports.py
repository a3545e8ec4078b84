"""Scenes after public bug reports: the right value, or the same picture as a twin that says the same otherwise.

They lie in the folder `reports` of $PELLUCID_TEST_DATA, whose INDEX.md says what each of them is. Two pictures are equal
if at most 0.5% of the pixels differ by more than 0.05 in linear radiance: at silhouettes, and where two contacts of a
scene meet, the last digit of a position decides."""
import os
import sys

import cli
from cli import CliTest
from pictures import read_exr

DATA = os.environ.get("PELLUCID_TEST_DATA", "")
REPORTS = os.path.join(DATA, "reports")

# Each way to draw, and what makes it quiet and quick enough.
WAYS = {"balanced": [], "visibility-cube": [], "path": ["--samples", "16"], "reference": []}

ROD = "node 1"  # of 06-pool-rod.glb

# Scenes whose paths meet other triangles: pictures of few paths per pixel differ by their noise.
OTHER_NOISE = {"06-cup-tinyoverlap.glb"}

TWINS = [
    ("04-two-materials-split.glb", "04-two-materials-one.glb"),
    ("04-two-materials-twonodes.glb", "04-two-materials-one.glb"),
    ("05-tilt-0.glb", "05-tilt-1e-09.glb"),
    ("06-cup-tinyoverlap.glb", "06-cup-exact.glb"),
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


class ReportTest(CliTest):
    def draw(self, name, way, *arguments, size="64x64"):
        result = self.render(os.path.join(REPORTS, name), "--technique", way, *WAYS[way], *arguments,
                             output="out.exr", size=size)
        self.assertEqual(result.returncode, 0, result.stderr)
        return read_exr(self.read("out.exr"))

    def middle(self, picture):
        at = (picture.height // 2 * picture.width + picture.width // 2) * len(picture.channels)
        values = dict(zip(picture.channels, picture.pixels[at:at + len(picture.channels)]))
        return [values[c] for c in "RGB"]


class TwinReports(ReportTest):
    def test_twins_are_equal(self):
        for name, twin in TWINS:
            for way in WAYS:
                if way == "path" and name in OTHER_NOISE:
                    continue
                with self.subTest(name, way=way):
                    self.assertLessEqual(differing(self.draw(name, way), self.draw(twin, way)), 0.005)


class ReportValues(ReportTest):
    def test_rod_displaces_the_water(self):
        """However long it is: it has less volume. A priority says the same, or the opposite."""
        for way in WAYS:
            with self.subTest(way):
                rod = self.draw("06-pool-rod.glb", way)
                self.assertLessEqual(differing(rod, self.draw("06-pool-rod.glb", way, "--priority", ROD + "=1")), 0.0)
                self.assertGreater(differing(rod, self.draw("06-pool-rod.glb", way, "--priority", ROD + "=-1")), 0.005)

    def test_eye_in_coloured_water(self):
        """What it sees directly is absorbed: an unlit square of (1, .3, .1), 2.2 m away along the axis; of the light of
        each colour (.3, .7, .9) is left after 2 m."""
        right = [color * left ** (2.2 / 2) for color, left in zip((1, 0.3, 0.1), (0.3, 0.7, 0.9))]
        for way in ("balanced", "visibility-cube", "path"):
            with self.subTest(way):
                picture = self.draw("20-inside.glb", way)
                n = len(picture.channels)
                red, green, blue = (picture.pixels[picture.channels.index(c)::n] for c in "RGB")
                at = max(range(len(red)), key=lambda i: red[i] - blue[i])
                for got, expected in zip((red[at], green[at], blue[at]), right):
                    self.assertAlmostEqual(got, expected, delta=0.05 * expected)

    def test_alpha_is_coverage_of_thin_glass(self):
        for way in ("balanced", "visibility-cube", "path"):
            with self.subTest(way):
                result = self.render(os.path.join(REPORTS, "17-alpha-blend-1.glb"), "--technique", way)
                self.assertNotIn("alpha", result.stderr)
                self.assertGreater(differing(self.draw("17-alpha-blend-0.4.glb", way),
                                             self.draw("17-alpha-blend-1.glb", way)), 0.1)

    def test_back_faces_are_not_drawn(self):
        """A red square that faces away, before a green one."""
        for way in WAYS:
            with self.subTest(way):
                r, g, b = self.middle(self.draw("single-sided-seen-from-behind.gltf", way, "--environment", "uniform"))
                self.assertGreater(g, 10 * r)

    def test_slab_seen_straight_on(self):
        """Two faces reflect .04 each and 2 m absorb half, three quarters and none per metre; a wall of (.8, .2, .2)."""
        left = [0.96 ** 2 * c ** 2 for c in (0.5, 0.25, 1.0)]
        for way in ("balanced", "visibility-cube", "reference"):
            for name, behind in (("05-tilt-0.glb", (1, 1, 1)), ("05-ortho-box-behind.glb", (0.8, 0.2, 0.2))):
                if way == "reference" and behind != (1, 1, 1):
                    continue  # its picture has no opaque things behind glass
                with self.subTest(name, way=way):
                    found = self.middle(self.draw(name, way, "--environment", "uniform"))
                    for got, share, color in zip(found, left, behind):
                        self.assertAlmostEqual(got, share * color + 0.04, delta=0.001)


if __name__ == "__main__":
    if not os.path.isdir(REPORTS):
        print("PELLUCID_TEST_DATA has no folder reports")
        sys.exit(cli.SKIPPED)
    cli.main()
