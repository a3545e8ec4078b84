"""`pellucid compare`: the measures, the report, and what it refuses."""
import json
import os
import struct
import unittest

import cli
from cli import CliTest

STATUSES = ["ok", "missing_layer", "left_screen", "step_limit", "event_limit"]


class Compare(CliTest):
    def compare(self, *arguments, size="48x48", **options):
        """By the exact transmitted path where no truth is given, which is quick."""
        truth = () if "--truth" in arguments else ("--truth", "reference")
        return self.run_cli("compare", *arguments, *truth, "--size", size, "--validate", **options)

    def runs(self, *arguments, **options):
        result = self.compare(*arguments, "--json", "runs.json", **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(self.read("runs.json"))

    def test_json(self):
        content = self.runs("shape:sphere", "shape:torus", "--techniques", "one-interface,wang-2014", "--views", "2")
        for key in ("device", "driver", "version"):
            self.assertIsInstance(content[key], str)
        runs = content["runs"]
        self.assertEqual([(run["scene"], run["view"], run["technique"]) for run in runs],
                         [(scene, view, technique) for scene in ("shape:sphere", "shape:torus") for view in (0, 1)
                          for technique in ("one-interface", "wang-2014")])
        for run in runs:
            self.assertEqual((run["width"], run["height"]), (48, 48))
            self.assertGreater(run["triangles"], 0)
            self.assertGreater(run["covered"], 0)
            for key in ("stable_share", "self_within_1deg", "within_1deg", "within_5deg", "within_1deg_stable",
                        "flip_mean"):
                self.assertGreaterEqual(run[key], 0, key)
                self.assertLessEqual(run[key], 1, key)
            self.assertLessEqual(run["within_1deg"], run["within_5deg"])
            self.assertLessEqual(run["median_deg"], run["p95_deg"])
            self.assertGreaterEqual(run["rmse"], 0)
            self.assertEqual(list(run["status"]), STATUSES)
            self.assertAlmostEqual(sum(run["status"].values()), 1)
            groups = run["by_events"]
            self.assertEqual(list(groups), ["2", "4", "more", "tir"])
            self.assertAlmostEqual(sum(groups[name]["share"] for name in ("2", "4", "more")), 1)
            self.assertGreater(run["frame_ms"], 0)

    def test_known_accuracy(self):
        """On a sphere two interfaces are all there is: wang-2014 is right, one-interface is not."""
        one, wang = self.runs("shape:sphere", "--techniques", "one-interface,wang-2014", "--views", "1",
                              size="128x128")["runs"]
        self.assertGreater(wang["within_1deg"], 0.995)
        self.assertGreater(wang["within_1deg_stable"], 0.998)
        self.assertLess(one["within_1deg"], 0.02)
        # At the very rim the interpolated normal turns an exit into a reflection.
        self.assertLess(wang["by_events"]["more"]["share"], 0.005)
        self.assertLess(wang["flip_mean"], 0.01)
        self.assertGreater(one["flip_mean"], 0.05)
        # 70% of the height: a disc of 0.7 x 128 pixels.
        self.assertAlmostEqual(wang["covered"] / (3.14159 / 4 * (0.7 * 128) ** 2), 1, delta=0.01)

    def test_reference_is_exact(self):
        """The reference held against itself: no error, and FLIP 0 against its own picture."""
        run, = self.runs("shape:knot", "--techniques", "reference", "--views", "1")["runs"]
        self.assertEqual(run["within_1deg"], 1)
        self.assertEqual(run["p95_deg"], 0)
        self.assertEqual(run["flip_mean"], 0)
        self.assertEqual(run["rmse"], 0)
        self.assertNotIn("frame_ms", run)

    def test_default_techniques_are_no_references(self):
        runs = self.runs("shape:cube", "--views", "1", size="16x16")["runs"]
        names = [run["technique"] for run in runs]
        self.assertIn("wang-2014", names)
        self.assertNotIn("reference", names)
        self.assertNotIn("path", names)

    def test_truth_by_path_tracing(self):
        """All light against the exact transmitted path: reflections inside are missing from the latter."""
        arguments = ("shape:sphere", "--techniques", "reference", "--views", "1", "--environment", "sky")
        run, = self.runs(*arguments, "--truth", "path", "--truth-samples", "16")["runs"]
        self.assertGreater(run["flip_mean"], 0.005)

    def test_the_default_truth_has_all_light(self):
        """Techniques that draw what is reflected inside are nearer to it than those that do not."""
        result = self.run_cli("compare", "shape:sphere", "--techniques", "reference,balanced", "--views", "1", "--size", "32x32",
                              "--environment", "sky", "--json", "runs.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        content = json.loads(self.read("runs.json"))
        straight, whole = content["runs"]
        self.assertEqual(content["truth"], "path")
        samples = content["truth_samples"]
        self.assertEqual(samples, straight["truth_samples"])
        self.assertEqual(content["image_truth"], f"path, samples per pixel: 16{f' to {samples}' if samples > 16 else ''}")
        self.assertLess(whole["flip_mean"], straight["flip_mean"])
        difference = straight["flip_mean"] - whole["flip_mean"]
        # Twice the samples until the noise is a third of the difference; or a warning.
        self.assertIn(straight["truth_samples"], (16, 32, 64))
        self.assertGreater(straight["truth_noise"], 0)
        self.assertEqual(straight["truth_noise"] > difference / 3, "noise" in result.stderr)
        self.assertEqual(any("noise" in warning for warning in content["warnings"]), "noise" in result.stderr)

    def test_noise_of_the_truth(self):
        """It falls with the square root of the samples, and is told where differences are smaller."""
        def noise(samples):
            arguments = ("shape:knot", "--techniques", "one-interface,wyman-2005", "--views", "1", "--environment", "sky")
            content = self.runs(*arguments, "--truth", "path", "--truth-samples", str(samples), size="64x64")
            self.assertEqual((content["truth_samples"], content["runs"][0]["truth_samples"]), (samples, samples))
            return content["runs"][0]["truth_noise"], " ".join(content["warnings"])
        few, many = noise(4), noise(64)
        self.assertGreater(few[0] / many[0], 2)
        self.assertLess(few[0] / many[0], 8)
        self.assertIn("1 of 1 views", few[1])

    def test_report(self):
        result = self.compare("shape:sphere", "--views", "1", "--html", "report")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(os.path.join("report", "index.html"), self.files())
        pictures = [file for file in self.files() if file.endswith(".png")]
        # The exact picture; picture, analysis, error and FLIP of each technique.
        self.assertGreaterEqual(len(pictures), 1 + 4 * 2)

    def test_a_bad_scene_loses_nothing(self):
        self.write("bad.obj", "v 1 2\n")
        result = self.compare("bad.obj", "shape:sphere", "--views", "1", "--json", "runs.json",
                              "--techniques", "one-interface")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"\Apellucid: left out: bad\.obj: line 1[^\n]*\n"
                                        r"pellucid: 1 of 2 scenes could not be read: bad\.obj\n\Z")
        content = json.loads(self.read("runs.json"))
        self.assertEqual(len(content["runs"]), 1)
        self.assertRegex(content["warnings"][0], r"^left out: bad\.obj: line 1")

    def test_a_bad_scene_alone(self):
        self.assert_refused(self.compare("missing.obj", "--views", "1"), "missing.obj: no such file")

    def test_stable_pixels(self):
        """What is unstable on a cube are the pixels within 0.1 px of an edge that is seen: ten times as many
        with shifts of a pixel, a tenth of them with 0.01."""
        cube, = self.runs("shape:cube", "--techniques", "reference", "--views", "1", size="128x128")["runs"]
        self.assertGreater(cube["stable_share"], 0.97)
        self.assertLess(cube["stable_share"], 0.997)
        self.assertGreater(cube["self_within_1deg"], 0.999)

    def test_exact_events(self):
        """The number of events holds for the exact paths, the reference, and its picture alike."""
        run, = self.runs("shape:knot", "--techniques", "reference", "--views", "1", "--exact-events", "3")["runs"]
        self.assertEqual(run["parameters"], {"events": 3})
        self.assertEqual((run["within_1deg"], run["flip_mean"]), (1, 0))
        self.assertGreater(run["status"]["event_limit"], 0.05)

    def test_views_can_be_drawn_again(self):
        first, second = self.runs("shape:torus", "--techniques", "one-interface", "--views", "2", size="32x32")["runs"]
        self.assertRegex(first["camera"], r"^orbit:0,15,[0-9.]+$")
        self.assertRegex(second["camera"], r"^orbit:180,15,[0-9.]+$")
        result = self.render("shape:torus", "--camera", first["camera"], "--technique", "one-interface", "--json",
                             "out.json", size="32x32")
        self.assert_rendered(result)
        self.assertAlmostEqual(json.loads(self.read("out.json"))["covered"], first["covered"], delta=2)

    def test_nothing_covered(self):
        """Without glass there are no shares, and no perfect score."""
        with open(self.path("triangle.bin"), "wb") as file:
            file.write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        self.write("opaque.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]}))
        run, = self.runs("opaque.gltf", "--techniques", "one-interface", "--views", "1")["runs"]
        self.assertEqual(run["covered"], 0)
        for key in ("within_1deg", "within_1deg_stable", "self_within_1deg", "stable_share", "median_deg", "flip_mean"):
            self.assertIsNone(run[key], key)

    def test_an_older_report_survives_a_bad_scene(self):
        arguments = ("--techniques", "one-interface", "--views", "1", "--html", "report")
        self.assertEqual(self.compare("shape:sphere", *arguments, size="16x16").returncode, 0)
        before = self.files()
        self.assert_refused(self.compare("nowhere.obj", *arguments, size="16x16"), "nowhere.obj")
        self.assertEqual(self.files(), before)

    def test_inputs_are_not_overwritten(self):
        self.write("solid.obj", cli.TETRAHEDRON)
        for words, arguments in (
                (["overwrite"], ("solid.obj", "--json", "solid.obj")),
                (["solid.obj", "overwrite"], ("solid.obj", "--json", "./solid.obj")),
                (["--html"], ("solid.obj", "--json", "report/runs.json", "--html", "report"))):
            os.makedirs(self.path("report"), exist_ok=True)
            with self.subTest(arguments):
                self.assert_refused(self.run_cli("compare", *arguments), *words)
                self.assertEqual(self.read("solid.obj"), cli.TETRAHEDRON.encode())

    def test_truth_takes_its_parameters(self):
        content = self.runs("shape:sphere", "--techniques", "one-interface", "--views", "1", "--truth", "path",
                            "--truth-samples", "2", "--seed", "7", size="16x16")
        self.assertEqual(content["image_truth_parameters"], {"events": 16, "seed": 7, "vertices": 256, "photons": 20000})

    def test_refusals(self):
        for words, arguments in (
                (["unknown technique 'nonsense'", "wang-2014"], ("shape:sphere", "--techniques", "nonsense")),
                (["twice"], ("shape:sphere", "shape:sphere")),
                (["--views"], ("shape:sphere", "--views", "0")),
                (["--truth"], ("shape:sphere", "--truth", "wang-2014")),
                (["samples"], ("shape:sphere", "--samples", "0")),
                (["samples"], ("shape:sphere", "--truth", "path", "--truth-samples", "0")),
                (["size"], ("shape:sphere", "--size", "2000000x2")),
                (["--steps"], ("shape:sphere", "--techniques", "one-interface", "--steps", "10")),
                (["nowhere"], ("shape:sphere", "--json", "nowhere/runs.json"))):
            with self.subTest(arguments):
                self.assert_refused(self.run_cli("compare", "--size", "16x16", *arguments), *words)


if __name__ == "__main__":
    cli.main()
