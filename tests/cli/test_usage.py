"""Arguments: what is not understood is refused, and what is known is said."""
import json

import cli
from cli import CliTest


class Commands(CliTest):
    def test_version(self):
        result = self.run_cli("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"\A\d+\.\d+\.\d+\n\Z")

    def test_help(self):
        for arguments in (["--help"], ["render", "--help"], ["info", "--help"]):
            result = self.run_cli(*arguments)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("Exit codes", result.stdout + self.run_cli("--help").stdout)

    def test_no_or_unknown_command(self):
        self.assert_refused(self.run_cli(), "no command", "pellucid --help")
        self.assert_refused(self.run_cli("paint"), "paint", "known: ", "render", "info")
        self.assert_refused(self.run_cli("--paint"), "--help")

    def test_missing_arguments(self):
        self.assert_refused(self.run_cli("render"), "scene")
        self.assert_refused(self.run_cli("render", "shape:sphere"), "--output")
        self.assert_refused(self.run_cli("render", "shape:sphere", "-o"), "--output")

    def test_too_many_arguments(self):
        self.refuses("--colour", "--colour", "red")
        self.refuses("shape:torus", "shape:torus")

    def test_the_last_of_one_option_counts(self):
        self.assert_rendered(self.render("shape:sphere", "--size", "9x7", "--json", "out.json"))
        described = json.loads(self.read("out.json"))
        self.assertEqual((described["width"], described["height"]), (9, 7))

    def test_exit_code_does_not_need_stderr(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            self.assertEqual(self.run_cli("render", "nowhere.obj", "-o", "out.png", stdout=full, stderr=full).returncode, 2)


class Registry(CliTest):
    """The listings show what the registry of techniques has."""

    def test_techniques_and_parameters(self):
        described = {each["name"]: each for each in json.loads(self.run_cli("techniques", "--json").stdout)["techniques"]}
        techniques = self.known_names("--technique", "?")
        self.assertGreaterEqual(len(techniques), 2)
        for technique in techniques:
            result = self.render("shape:sphere", "--technique", technique, "--json", "out.json")
            if result.returncode == 3:  # the device lacks what this one needs, and nothing was written
                self.assert_refused(result, technique, "needs", "lacks", code=3)
                continue
            self.assert_rendered(result)
            drawn = json.loads(self.read("out.json"))
            self.assertEqual("stands_for" in drawn, technique in ("fast", "balanced", "exact"))
            if "stands_for" in drawn:
                continue  # a preset has parameters of its own
            self.assertEqual(drawn["parameters"],
                             {each["name"]: each["default"] for each in described[technique]["parameters"]})

    def test_aovs_and_shapes(self):
        text = self.run_cli("help", "aovs").stdout
        for aov in self.known_names("--aov", "?=out.exr"):
            self.assertRegex(text, rf"(?m)^  {aov} ")
        self.assertIn("shape:sphere: ", self.run_cli("help", "shapes").stdout)

    def test_parameters_are_used(self):
        self.assert_rendered(self.render("shape:sphere", "--technique", "wang-2014", "--steps", "7", "--json", "out.json"))
        self.assertEqual(json.loads(self.read("out.json"))["parameters"]["steps"], 7)

    def test_environment_is_turned_and_scaled(self):
        def drawn(*arguments):
            self.assert_rendered(self.render("shape:torus", "--environment", "sky", "--json", "out.json", *arguments))
            values = json.loads(self.read("out.json"))
            self.assertEqual(values["environment"], "sky")
            return self.read("out.png"), values["environment_rotation_deg"], values["environment_intensity"]

        plain = drawn()
        self.assertEqual(plain[1:], (0, 1))
        self.assertEqual(drawn("--environment-rotation", "720")[0], plain[0])
        turned = drawn("--environment-rotation", "-90")
        brighter = drawn("--environment-rotation", "-90", "--environment-intensity", "2")
        self.assertEqual(brighter[1:], (-90, 2))
        self.assertEqual(len({plain[0], turned[0], brighter[0]}), 3)


class Names(CliTest):
    """An unknown name is refused with the known ones."""

    def test_unknown(self):
        self.refuses(["glas", "known: ", "one-interface", "wang-2014"], "--technique", "glas")
        self.refuses(["front", "known: ", "orbit:AZ,EL,DIST"], "--camera", "front")
        self.refuses(["xray", "known: ", "radiance", "analysis"], "--view", "xray")
        self.refuses(["filmic", "known: ", "none", "reinhard", "aces", "neutral", "krawczyk"], "--tonemap", "filmic")
        self.refuses(["guess", "known: ", "single-pass", "depth-peeling", "dual-depth-peeling"], "--layer-builder", "guess")
        self.refuses(["cave", "studio", "checker", "sky", ".hdr", ".exr"], "--environment", "cave")
        for intensity in ("-1", "nan", "1e999", "bright", ""):
            self.refuses("--environment-intensity", "--environment-intensity", intensity)
        for rotation in ("inf", "left", ""):
            self.refuses("--environment-rotation", "--environment-rotation", rotation)
        self.refuses(["Voodoo", "found: "], "--device", "Voodoo")
        self.refuses("edge", scene="shape:cube,edge=1")
        self.refuses(["teapot", "sphere", "goblet"], scene="shape:teapot")
        aovs = ["exit-direction", "exit-position", "path-length", "events", "status", "layers", "depth", "normal", "object"]
        self.refuses(["albedo", "known: ", *aovs], "--aov", "albedo=a.exr")

    def test_parameter_of_another_technique(self):
        self.refuses(["one-interface", "steps"], "--technique", "one-interface", "--steps", "3")

    def test_empty_names(self):
        for flag in ("--technique", "--camera", "--view", "--tonemap", "--environment", "--attenuation-color"):
            self.refuses("''", flag, "")
        self.refuses("", "--json", "")
        self.refuses("''", output="")
        self.refuses("", scene="")


class Sizes(CliTest):
    def test_refused(self):
        for size in ("0x0", "512", "512x", "x512", "-1x5", "5x-1", "1x1x1", "axb", "4.5x4", "512X512", " 5x5", "",
                     "99999999999x5", "0x5", "5x0"):
            self.refuses(["--size", f"'{size}'"], size=size)
        self.refuses("100000x100000", size="100000x100000")

    def test_rendered(self):
        for size in ("1x1", "17x13", "4001x3", "3x401"):
            with self.subTest(size):
                self.assert_rendered(self.render("shape:goblet", "--json", "out.json", size=size))
                described = json.loads(self.read("out.json"))
                self.assertEqual(f"{described['width']}x{described['height']}", size)


class Numbers(CliTest):
    def test_not_a_number(self):
        for flag in ("--samples", "--error", "--exposure", "--ior", "--fov", "--attenuation-distance", "--crease-angle", "--steps"):
            for value in ("abc", "", "1x", "1e999", "nan", "inf"):
                self.refuses(flag, flag, value)

    def test_out_of_range(self):
        for value in ("0", "-1", "4294967296", "1.5"):
            self.refuses("samples", "--samples", value)
        for value in ("0", "-1.5", "0.99"):
            self.refuses("ior", "--ior", value)
        for value in ("0", "-40", "180"):
            self.refuses("--fov", "--fov", value)
        for value in ("-1", "181"):
            self.refuses("--crease-angle", "--crease-angle", value)
        for value in ("0", "-1"):
            self.refuses("attenuation", "--attenuation-distance", value)
        for value in ("0", "-3", "2.5", "1e9"):
            self.refuses(["wang-2014", "steps"], "--technique", "wang-2014", "--steps", value)

    def test_lists(self):
        for value in ("1,2", "1,1,1,1", "1;1;1", "1,,1", "2,0,0", "-1,0,0", "nan,1,1", "1,1,"):
            self.refuses("attenuation", "--attenuation-color", value)
        for value in ("orbit:", "orbit:1,2", "orbit:1,2,3,4", "orbit:a,b,c", "orbit:0,91,3", "orbit:0,0,1", "orbit:0,0,-3",
                      "orbit:nan,0,3"):
            self.refuses("--camera", "--camera", value)

    def test_negative_ones_are_values(self):
        self.assert_rendered(self.render("shape:sphere", "--exposure", "-1.5", "--camera", "orbit:-30,-20,3.5",
                                         "--attenuation-color", "0.5,1,1"))


if __name__ == "__main__":
    cli.main()
