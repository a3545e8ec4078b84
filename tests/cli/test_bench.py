"""`pellucid bench`: its JSON, its suites, and what it refuses."""
import json
import os
import unittest

import cli
from cli import CliTest, TETRAHEDRON


class Bench(CliTest):
    def bench(self, *arguments, size="32x32", frames="2", **options):
        return self.run_cli("bench", *arguments, "--size", size, "--frames", frames, "--validate", **options)

    def measure(self, *arguments, **options):
        result = self.bench(*arguments, "--json", "bench.json", **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(self.read("bench.json"))

    def test_json(self):
        content = self.measure("shape:sphere,segments=8", "shape:gem", "--techniques", "wang-2014,one-interface",
                               "--steps", "30", frames="7")
        for key in ("device", "driver", "version", "cpu"):
            self.assertTrue(content[key], key)
        self.assertLessEqual(1, content["cpu_threads"])
        self.assertLessEqual(content["cpu_threads"], len(os.sched_getaffinity(0)))
        self.assertEqual(content["command"], "pellucid bench shape:sphere,segments=8 shape:gem --techniques "
                         "wang-2014,one-interface --size 32x32 --frames 7 --validate --steps 30")
        runs = content["runs"]
        self.assertEqual([(run["scene"], run["technique"]) for run in runs],
                         [(scene, technique) for scene in ("shape:sphere,segments=8", "shape:gem")
                          for technique in ("wang-2014", "one-interface")])
        self.assertEqual([run["triangles"] for run in runs], [512, 512, 110, 110])
        self.assertEqual(runs[0]["parameters"]["steps"], 30)
        self.assertNotIn("steps", runs[1]["parameters"])
        for run in runs:
            self.check_run(run)

    def check_run(self, run):
        self.assertEqual((run["width"], run["height"], run["objects"], run["frames"]), (32, 32, 1, 7))
        self.assertGreater(run["covered"], 0)
        self.assertGreater(run["layers"], 0)
        self.assertGreater(run["embree_within_1deg"], 0.98)
        for key in ("stable_share", "within_1deg", "within_1deg_stable", "embree_within_1deg"):
            self.assertGreaterEqual(run[key], 0)
            self.assertLessEqual(run[key], 1)
        self.assertLessEqual({"layers", "trace", "shade"}, set(run["passes"]))
        for times in [run["frame_ms"], *run["passes"].values()]:
            self.assertGreaterEqual(times["median"], 0)
            self.assertGreaterEqual(times["p95"], times["median"])
        self.assertGreaterEqual(run["frame_ms"]["p95"], max(times["median"] for times in run["passes"].values()))
        self.assertGreater(run["embree_ms"], 0)
        self.assertGreater(run["embree_build_ms"], 0)
        self.assertIn(run["embree_packet"], (1, 4, 8, 16))
        self.assertAlmostEqual(run["ratio_embree"], run["embree_ms"] / run["frame_ms"]["median"])
        self.assertNotIn("embree_refit_ms", run)

    def test_accuracy_is_that_of_compare(self):
        """The times belong to paths of known accuracy, those that `compare` measures."""
        run, = self.measure("shape:knot", "--techniques", "wang-2014", size="64x64")["runs"]
        self.assertEqual(self.run_cli("compare", "shape:knot", "--techniques", "wang-2014", "--size", "64x64",
                                      "--truth", "reference", "--views", "1", "--json", "compare.json").returncode, 0)
        compared, = json.loads(self.read("compare.json"))["runs"]
        for key in ("covered", "stable_share", "within_1deg", "within_1deg_stable"):
            self.assertEqual(run[key], compared[key], key)

    def test_deforming(self):
        run, = self.measure("shape:torus", "--techniques", "one-interface", "--deforming")["runs"]
        times = [run["embree_refit_ms"], run["embree_rebuild_ms"]["low"], run["embree_rebuild_ms"]["medium"]]
        self.assertGreater(min(times), 0)
        self.assertGreater(run["embree_deforming_ms"], min(times))
        self.assertAlmostEqual(run["ratio_embree_deforming"], run["embree_deforming_ms"] / run["frame_ms"]["median"])

    def test_every_frame_has_the_same_passes(self):
        """The first frames of a block that draws one sample would be drawn otherwise."""
        for frames in ("1", "6"):
            run, = self.measure("shape:cube", "--techniques", "one-interface", frames=frames)["runs"]
            self.assertEqual(run["frames"], int(frames))
            self.assertIn("accumulate", run["passes"])

    def test_threads(self):
        self.assertEqual(self.measure("shape:cube", "--techniques", "one-interface", "--threads", "1")["cpu_threads"],
                         1)

    def test_what_is_read_is_not_overwritten(self):
        self.write("cell.obj", TETRAHEDRON)
        for source in ("cell.obj", "./cell.obj"):
            self.assert_refused(self.run_cli("bench", "cell.obj", "--json", source), "cell.obj", "overwrite")
        self.assertEqual(self.read("cell.obj").decode(), TETRAHEDRON)

    def test_command_has_no_folders(self):
        os.mkdir(self.path("models"))
        self.write("models/cell.obj", TETRAHEDRON)
        content = self.measure(self.path("models/cell.obj"), "--techniques", "one-interface", "--models",
                               self.path("models"))
        self.assertIn("bench cell.obj ", content["command"])
        self.assertIn("--models DIR", content["command"])
        self.assertNotIn("/", content["command"])

    def test_table(self):
        result = self.bench("shape:sphere", "--techniques", "one-interface")
        head, row = result.stdout.splitlines()
        self.assertEqual(len(head), len(row))
        self.assertIn("one-interface", row)
        self.assertEqual(result.stderr, "")  # no progress bar where nobody watches
        self.assertEqual(self.files(), [])

    def test_default_techniques_are_no_references(self):
        names = [run["technique"] for run in self.measure("shape:cube")["runs"]]
        self.assertIn("wang-2014", names)
        self.assertNotIn("reference", names)

    def test_a_bad_scene_loses_nothing(self):
        result = self.bench("missing.obj", "shape:sphere", "--techniques", "one-interface", "--json", "bench.json")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"\Apellucid: left out: missing\.obj[^\n]*\n"
                                        r"pellucid: 1 of 2 scenes could not be read: missing\.obj\n\Z")
        content = json.loads(self.read("bench.json"))
        self.assertEqual(len(content["runs"]), 1)
        self.assertRegex(content["warnings"][0], r"^left out: missing\.obj")

    def test_refusals(self):
        for words, arguments in (
                (["give scenes", "--suite"], ()),
                (["unknown suite 'nonsense'", "quick", "thesis", "scaling"], ("--suite", "nonsense")),
                (["unknown technique 'nonsense'", "wang-2014"], ("shape:sphere", "--techniques", "nonsense")),
                (["reference", "CPU"], ("shape:sphere", "--techniques", "reference")),
                (["--steps"], ("shape:sphere", "--techniques", "one-interface", "--steps", "10")),
                (["--models", "nowhere"], ("--suite", "thesis", "--models", "nowhere")),
                (["--frames"], ("shape:sphere", "--frames", "0")),
                (["--size"], ("shape:sphere", "--size", "big")),
                (["size 2000000x2"], ("shape:sphere", "missing.obj", "--size", "2000000x2")),
                (["steps"], ("missing.obj", "--techniques", "wang-2014", "--steps", "-1")),
                (["nowhere"], ("shape:sphere", "--json", "nowhere/bench.json"))):
            with self.subTest(arguments):
                self.assert_refused(self.run_cli("bench", *arguments), *words)


class BenchSuites(CliTest):
    def suite(self, name, *arguments):
        result = self.run_cli("bench", "--suite", name, "--techniques", "one-interface", "--size", "24x24", "--frames",
                              "1", "--json", "bench.json", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result, json.loads(self.read("bench.json"))

    def test_quick(self):
        _, content = self.suite("quick")
        self.assertEqual(content["suite"], "quick")
        self.assertGreaterEqual(len(content["runs"]), 2)

    def test_thesis(self):
        """The paper's triangle counts, each far and near; models come from the folder."""
        os.mkdir(self.path("models"))
        self.write("models/cow.obj", TETRAHEDRON)
        self.write("models/bunny.obj", TETRAHEDRON)
        result, content = self.suite("thesis", "--models", "models")
        self.assertEqual([(run["scene"], run["distance"], run["triangles"]) for run in content["runs"]],
                         [(scene, distance, triangles) for distance in (10, 5) for scene, triangles in
                          (("shape:sphere,segments=8", 512), ("cow.obj", 4), ("shape:torus,segments=24,sides=12", 576),
                           ("shape:infinity-ring,segments=60,sides=20", 2400), ("bunny.obj", 4))])
        far, near = (run for run in content["runs"] if run["scene"].startswith("shape:sphere"))
        self.assertGreater(near["covered"], 3 * far["covered"])
        self.assertNotIn("left out", result.stderr)

    def test_missing_models(self):
        os.mkdir(self.path("empty"))
        result, content = self.suite("thesis", "--models", "empty")
        self.assertRegex(result.stderr, r"(?m)^pellucid: warning: cow is left out: the folder of --models has no cow\.obj$")
        self.assertEqual(sum("cow is left out" in warning for warning in content["warnings"]), 1)
        self.assertEqual([run["scene"] for run in content["runs"] if "cow" in run["scene"]], [])
        self.assertGreaterEqual(len(content["runs"]), 6)


if __name__ == "__main__":
    cli.main()
