"""Light through solids: pellucid thickness, compare --thickness, and the options by which render lets light through."""
import json
import os

import cli
from cli import CliTest
from pictures import read_exr

BALL = "shape:sphere,segments=64"
RADIUS = 1  # m
WAX = ["--translucent", "0.8,0.3,0.1,0.5"]
METHODS = ["translucent-shadow-map", "local-thickness", "depth-peeling", "dual-depth-peeling", "layers",
           "published-shadow-map", "published-local-thickness", "published-depth-peeling"]


def sun(azimuth):
    return ["--add-light", f"sun:{azimuth},0"]


class Thickness(CliTest):
    def measure(self, *arguments):
        run = self.run_cli("thickness", BALL, "-o", "d.exr", "--size", "96x96", "--json", "d.json", *WAX, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(self.read("d.json"))

    def test_a_ball_lit_from_behind_is_as_thick_as_its_diameter(self):
        found = self.measure(*sun(180), "--camera", "orbit:0,0,4")
        exact = self.measure(*sun(180), "--camera", "orbit:0,0,4", "--method", "exact")
        for measured in (found, exact):
            self.assertAlmostEqual(measured["largest_m"], 2 * RADIUS, delta=0.01 * RADIUS)
        self.assertAlmostEqual(found["mean_m"], exact["mean_m"], delta=0.005 * exact["mean_m"])

    def test_the_lit_side_has_none(self):
        self.assertEqual(self.measure(*sun(0), "--camera", "orbit:0,0,40")["largest_m"], 0)

    def test_published_forms(self):
        """Stored depths are right to a texel where light leaves, and wrong where it enters. Of the samples in half the diagonal of
        the box 55% lie inside a ball, 0.55 sqrt(3) radii."""
        lamp = ["--add-light", "lamp:0,0,-3,1"]
        for light in (sun(180), lamp):
            exact = self.measure(*light, "--camera", "orbit:0,0,4", "--method", "exact")
            for method in ("published-shadow-map", "published-depth-peeling"):
                found = self.measure(*light, "--camera", "orbit:0,0,4", "--method", method)
                self.assertAlmostEqual(found["largest_m"], 2 * RADIUS, delta=0.02 * RADIUS)
                self.assertAlmostEqual(found["mean_m"], exact["mean_m"], delta=0.02 * exact["mean_m"])
        for method in ("published-depth-peeling", "published-shadow-map"):
            found = self.measure(*sun(0), "--camera", "orbit:0,0,40", "--method", method)
            self.assertGreater(found["points"], found["lit"] + found["points"] // 10, method)
        baked = self.measure(*sun(180), "--camera", "orbit:0,0,4", "--method", "published-local-thickness")
        self.assertAlmostEqual(baked["largest_m"], 0.55 * 3 ** 0.5, delta=0.02)
        baked = self.measure(*sun(180), "--camera", "orbit:0,0,4", "--method", "local-thickness")
        self.assertAlmostEqual(baked["largest_m"], 4 / 3, delta=0.02)

    def test_every_method_runs(self):
        for method in METHODS:
            self.assertGreater(self.measure(*sun(180), "--method", method)["mean_m"], 0, method)

    def test_what_is_wrong_is_said_in_one_line(self):
        for arguments, reason in ((["--add-light", "sun:1"], "--add-light"), (["--add-light", "moon:1,2"], "sun"),
                                  (["--add-light", "sun:1,2,3,180"], "diameter"), (["--add-light", "sun:1,2,-3"], "intensity"),
                                  (["--add-light", "lamp:1,2,3,4,-5"], "size"), (["--add-light", "lamp:1,2,3,4,5,6"], "--add-light"),
                                  (["--add-light", "spot:0,0,0,0,0,0,30,1"], "nowhere"), ([], "--add-light"),
                                  ([*sun(0), "--method", "guess"], "guess"), ([*sun(0), "--light", "7"], "7"),
                                  ([*sun(0), "--layers", "0"], "layers"), ([*sun(0), "--picture", "x.jpg"], ".png")):
            run = self.run_cli("thickness", BALL, "-o", "d.exr", *WAX, *arguments)
            self.assertEqual(run.returncode, 2, arguments)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)
            self.assertIn(reason, run.stderr)
        self.assertEqual(self.files(), [])


class ThicknessComparison(CliTest):
    def test_every_method_from_three_sides_with_pictures(self):
        run = self.run_cli("compare", BALL, "--thickness", "--size", "96x96", "--json", "c.json", "--pictures", "p", *WAX,
                           *sun(180))
        self.assertEqual(run.returncode, 0, run.stderr)
        runs = json.loads(self.read("c.json"))["runs"]
        self.assertEqual([(r["view"], r["method"]) for r in runs],
                         [(view, method) for view in ("behind", "side", "top") for method in METHODS])
        for r in runs:
            if r["method"] in ("depth-peeling", "dual-depth-peeling", "layers"):
                self.assertLess(r["relative_error"], 0.005, r)
        self.assertEqual(len(os.listdir(self.path("p"))), 3 * (1 + 2 * len(METHODS)))

    def test_what_does_not_go_together_is_said(self):
        for arguments in (["--pictures", "p"], ["--thickness", "--html", "x.html"]):
            run = self.run_cli("compare", BALL, *WAX, *sun(0), *arguments)
            self.assertEqual(run.returncode, 2, arguments)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


class TranslucentPictures(CliTest):
    def test_light_comes_through(self):
        pictures = []
        for light in ([], sun(180)):
            run = self.run_cli("render", BALL, "-o", "x.exr", "--size", "64x64", *WAX, *light)
            self.assertEqual(run.returncode, 0, run.stderr)
            pictures.append(read_exr(self.read("x.exr")).pixels)
        dark, lit = pictures
        self.assertTrue(all(b >= a for a, b in zip(dark, lit)))
        self.assertGreater(sum(lit), 1.01 * sum(dark))

    def test_what_is_wrong_is_said_in_one_line(self):
        for value in ("1,1,1", "2,0,0,1", "1,1,1,0", "a,b,c,d"):
            run = self.run_cli("render", BALL, "-o", "x.png", "--translucent", value)
            self.assertEqual(run.returncode, 2, value)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


if __name__ == "__main__":
    cli.main()
