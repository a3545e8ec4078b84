"""pellucid thickness, and the options by which render lets light through solids."""
import json

import cli
from cli import CliTest

BALL = "shape:sphere,segments=64"
RADIUS = 1  # m
WAX = ["--translucent", "0.8,0.3,0.1,0.5"]


class Thickness(CliTest):
    def measure(self, *arguments):
        run = self.run_cli("thickness", BALL, "-o", "d.exr", "--size", "96x96", "--json", "d.json", *WAX, *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(self.read("d.json"))

    def test_a_ball_lit_from_behind_is_as_thick_as_its_chords(self):
        found = self.measure("--light", "180,0", "--camera", "orbit:0,0,4", "--exact")
        self.assertAlmostEqual(found["thickness"]["largest_m"], 2 * RADIUS, delta=0.01 * RADIUS)
        self.assertLess(found["error"]["relative"], 0.005)

    def test_the_lit_side_has_none(self):
        found = self.measure("--light", "0,0", "--camera", "orbit:0,0,40")
        self.assertEqual(found["thickness"]["largest_m"], 0)

    def test_every_method_runs(self):
        for method in ("translucent-shadow-map", "local-thickness", "depth-peeling", "dual-depth-peeling", "layers"):
            self.assertGreater(self.measure("--light", "180,0", "--thickness-method", method)["thickness"]["mean_m"], 0, method)

    def test_what_is_wrong_is_said_in_one_line(self):
        for arguments, reason in ((["--light", "1"], "--light"), (["--light", "0,100"], "elevation"), ([], "light"),
                                  (["--light", "0,0", "--thickness-method", "guess"], "guess"),
                                  (["--light", "0,0", "--light-number", "7"], "7"),
                                  (["--light", "0,0", "--thickness-layers", "0"], "layers")):
            run = self.run_cli("thickness", BALL, "-o", "d.exr", *WAX, *arguments)
            self.assertEqual(run.returncode, 2, arguments)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)
            self.assertIn(reason, run.stderr)
        self.assertEqual(self.files(), [])


class TranslucentPictures(CliTest):
    def test_light_comes_through(self):
        for name, light in (("dark", []), ("lit", ["--light", "180,10"])):
            run = self.run_cli("render", BALL, "-o", name + ".exr", "--size", "64x64", *WAX, *light)
            self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotEqual(self.read("dark.exr"), self.read("lit.exr"))

    def test_what_is_wrong_is_said_in_one_line(self):
        for value in ("1,1,1", "2,0,0,1", "1,1,1,0", "a,b,c,d"):
            run = self.run_cli("render", BALL, "-o", "x.png", "--translucent", value)
            self.assertEqual(run.returncode, 2, value)
            self.assertEqual(len(run.stderr.strip().splitlines()), 1, run.stderr)


if __name__ == "__main__":
    cli.main()
