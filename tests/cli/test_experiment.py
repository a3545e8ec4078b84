"""`pellucid experiment`: what there is, what it refuses, and the table, the figure and the JSON of a run."""
import json
import os
import re
import xml.dom.minidom

import cli
import pictures
from cli import CliTest, TETRAHEDRON

NAMES = ["wang-search-step", "wang-environment", "wang-footprint", "wang-layers", "wang-exits", "wang-steps", "wang-refractions",
         "index", "interfaces", "wyman-speed", "wang-table-4-1",
         "wang-many-objects", "chen-error", "chen-speed", "ihrke-rays", "ihrke-light",
         "ihrke-reflections", "kay-greenberg-transparency", "kay-greenberg-background"]


class Experiment(CliTest):
    def experiment(self, *arguments, size="96x96", frames="2"):
        return self.run_cli("experiment", *arguments, "--size", size, "--frames", frames, "--validate")

    def measure(self, *arguments, **options):
        result = self.experiment(*arguments, "--json", "experiment.json", **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result, json.loads(self.read("experiment.json"))

    def page(self, name, folder="out/experiments"):
        return self.read(f"{folder}/{name}/index.html").decode()

    def check_links(self, page_file):
        """Every file that a page names is there, and nothing comes from elsewhere."""
        page = self.read(page_file).decode()
        self.assertNotIn("<script", page)
        self.assertNotRegex(page, r"https?://(?!www\.w3\.org/)")
        for link in re.findall(r"(?:href|src)='([^']*)'", page):
            self.assertTrue(os.path.isfile(self.path(os.path.join(os.path.dirname(page_file), link))), link)

    def test_list(self):
        for arguments in ((), ("--list",), ("all", "--list")):
            result = self.run_cli("experiment", *arguments)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual([line.split()[0] for line in result.stdout.splitlines()], NAMES)
        self.assertEqual(self.files(), [])

    def test_refusals(self):
        for words, arguments in (
                (["unknown experiment 'nonsense'", *NAMES], ("wang-layers", "nonsense")),
                (["--models", "nowhere"], ("all", "--models", "nowhere")),
                (["--frames"], ("all", "--frames", "0")),
                (["--size"], ("all", "--size", "big")),
                (["size 2000000x2"], ("all", "--size", "2000000x2")),
                (["nowhere"], ("all", "--json", "nowhere/experiment.json"))):
            with self.subTest(arguments):
                self.assert_refused(self.run_cli("experiment", *arguments), *words)
        self.assertEqual(self.files(), [])

    def test_a_bad_model_loses_nothing(self):
        os.mkdir(self.path("models"))
        self.write("models/photon_dragon.obj", "v 1 2\n")
        result = self.experiment("wang-layers", "--models", "models", "--json", "runs.json", size="16x16")
        self.assertEqual(result.returncode, 2)
        lines = result.stderr.splitlines()
        self.assertRegex(lines[0], r"^pellucid: left out: models/photon_dragon\.obj: line 1")
        self.assertRegex(lines[-1], r"^pellucid: [0-9]+ scenes could not be read: ")
        self.assertEqual(len(json.loads(self.read("runs.json"))["experiments"]), 1)

    def test_missing_models(self):
        """Named in a warning; nothing is left of an experiment that has no other scene."""
        result, content = self.measure("wang-layers")
        self.assertRegex(result.stderr, r"warning: wang-layers: dragon is left out: .*photon_dragon\.obj")
        self.assertEqual(content["experiments"][0]["runs"], [])
        self.assertTrue(any("photon_dragon.obj" in warning for warning in content["experiments"][0]["warnings"]))
        self.assertFalse(os.path.exists(self.path("out/experiments/wang-layers")))
        result, content = self.measure("interfaces", size="24x24")
        self.assertIn("cow.obj", result.stderr)
        scenes = {run["scene"] for run in content["experiments"][0]["runs"]}
        self.assertLessEqual({"goblet", "torus", "knot", "bottle"}, scenes)
        self.assertNotIn("cow", scenes)

    def test_timed_experiment(self):
        """A curve over a parameter: table, plots, pictures and numbers agree."""
        os.mkdir(self.path("models"))
        self.write("models/photon_dragon.obj", TETRAHEDRON)
        result, content = self.measure("wang-layers", "--models", self.path("models"))
        # No progress bar where nobody watches; of four layers alone not every path through a tetrahedron is found.
        self.assertRegex(result.stderr, r"\A(pellucid: warning: wang-layers: dragon: wang-2014: \d+ of \d+ glass "
                                        r"pixels may be wrong by their status: [^\n]*\n)?\Z")
        for key in ("device", "driver", "version", "cpu"):
            self.assertTrue(content[key], key)
        one, = content["experiments"]
        self.assertEqual(one["name"], "wang-layers")
        self.assertEqual(one["command"], "pellucid experiment wang-layers --models DIR --size 96x96 --frames 2 --validate")
        self.assertEqual([run["parameters"]["layers"] for run in one["runs"]], [2, 4, 6, 8])
        for run in one["runs"]:
            self.assertEqual((run["width"], run["height"], run["triangles"], run["frames"]), (96, 96, 4, 2))
            self.assertGreater(run["covered"], 0)
            self.assertGreater(run["frame_ms"]["median"], 0)
            self.assertAlmostEqual(run["ratio_embree"], run["embree_ms"] / run["frame_ms"]["median"])
            self.assertAlmostEqual(run["fps"], 1000 / run["frame_ms"]["median"])
        table = self.read("out/experiments/wang-layers/wang-layers.md").decode()
        for run in one["runs"]:
            self.assertRegex(table, rf"\| dragon \| {run['parameters']['layers']:.0f} layers \| 4 \| "
                             rf"{100 * run['within_1deg']:.1f} \|")
        self.assertIn(one["command"], table)
        self.assertIn(content["device"], table)
        for plot in ("plot-1.svg", "plot-2.svg"):
            svg = xml.dom.minidom.parseString(self.read(f"out/experiments/wang-layers/{plot}"))
            self.assertGreater(len(svg.getElementsByTagName("circle")), 4)
        for page in ("wang-layers/index.html", "index.html"):
            self.check_links(f"out/experiments/{page}")
        for link in re.findall(r"\]\(([^)]*)\)", table):
            self.assertTrue(os.path.isfile(self.path(f"out/experiments/wang-layers/{link}")), link)

    def test_an_experiment_replaces_its_own_page_alone(self):
        self.measure("wang-many-objects", "--report", "pages", size="32x32")
        os.mkdir(self.path("models"))
        self.write("models/cow.obj", TETRAHEDRON)
        self.measure("wang-search-step", "--models", "models", "--report", "pages", size="32x32")
        index = self.read("pages/index.html").decode()
        for name in ("wang-many-objects", "wang-search-step"):
            self.assertIn(f"{name}/index.html", index)
        self.assertNotIn("wyman-speed/index.html", index)
        self.check_links("pages/index.html")
        before = self.files()
        self.measure("wang-search-step", "--models", "models", "--report", "pages", size="32x32")
        self.assertEqual(self.files(), before)

    def test_several_keep_what_an_earlier_run_has_measured(self):
        """Under the same conditions alone, and until --again; a single experiment always runs."""
        os.mkdir(self.path("models"))
        self.write("models/cow.obj", TETRAHEDRON)
        names = ["wang-search-step", "wang-many-objects"]
        results = [f"out/experiments/{name}/{name}.json" for name in names]

        def measure(*arguments, size="16x16"):
            before = [os.stat(self.path(file)).st_mtime_ns if os.path.isfile(self.path(file)) else 0 for file in results]
            result, content = self.measure(*(arguments or names), "--models", "models", size=size, frames="1")
            ran = [os.stat(self.path(file)).st_mtime_ns != time for file, time in zip(results, before)]
            return ran, result.stdout, content["experiments"]

        ran, output, first = measure()
        self.assertEqual(ran, [True, True])
        self.assertIn("[2/2] wang-many-objects\n", output)
        os.remove(self.path(results[1]))  # as if it had been interrupted
        ran, output, second = measure()
        self.assertEqual(ran, [False, True])
        self.assertIn("[1/2] wang-search-step: results kept\n", output)
        self.assertEqual(second, first)
        self.assertEqual(measure(size="24x24")[0], [True, True])
        self.assertEqual(measure(*names, "--again", size="24x24")[0], [True, True])
        self.assertEqual(measure(size="24x24")[0], [False, False])
        self.assertEqual(measure(names[0], size="24x24")[0], [True, False])

    def test_foreign_files_are_kept(self):
        os.makedirs(self.path("pages/wang-many-objects"))
        self.write("pages/wang-many-objects/index.html", "mine")
        self.assert_refused(self.run_cli("experiment", "wang-many-objects", "--size", "16x16", "--report", "pages"),
                            "index.html", "in the way")
        self.assertEqual(self.read("pages/wang-many-objects/index.html"), b"mine")

    def test_nothing_else_is_overwritten(self):
        """Not a model, not a page by the JSON, not another report by the index; and no older page stays as if new."""
        os.makedirs(self.path("models"))
        self.write("models/cow.obj", TETRAHEDRON)
        self.assert_refused(self.run_cli("experiment", "wang-search-step", "--models", "models", "--json", "models/cow.obj"),
                            "models/cow.obj")
        self.assertEqual(self.read("models/cow.obj").decode(), TETRAHEDRON)
        os.makedirs(self.path("pages"))
        self.assert_refused(self.run_cli("experiment", "wang-layers", "--report", "pages", "--json", "pages/x.json"),
                            "--json", "--report")
        self.write("triangle.obj", TETRAHEDRON)
        compared = self.run_cli("compare", "triangle.obj", "--size", "16x16", "--views", "1", "--techniques",
                                "one-interface", "--truth", "reference", "--html", "report")
        self.assertEqual(compared.returncode, 0, compared.stderr)
        before = self.files()
        self.assert_refused(self.experiment("wang-search-step", "--report", "report"), "another report")
        self.assertEqual(self.files(), before)
        self.measure("wang-search-step", "--models", "models", size="24x24")
        self.assertTrue(os.path.exists(self.path("out/experiments/wang-search-step/index.html")))
        self.measure("wang-search-step", size="24x24")
        self.assertFalse(os.path.exists(self.path("out/experiments/wang-search-step/index.html")))
        self.check_links("out/experiments/index.html")

    def test_environment_maps_converge_to_the_formula(self):
        _, content = self.measure("wang-environment", size="128x128")
        runs = [run for run in content["experiments"][0]["runs"] if run["scene"] == "torus"]
        self.assertEqual([run["map_width"] for run in runs], [256, 512, 1024])
        errors = [run["rmse"] for run in runs]
        self.assertGreater(errors[0], errors[1])
        self.assertGreater(errors[1], errors[2])
        self.assertGreater(errors[2], 0)
        exact = pictures.read_png(self.read("out/experiments/wang-environment/torus-procedural.png"))
        self.assertEqual((exact.width, exact.height), (128, 128))
        self.assertIn("torus-magnified-256-texels.png", self.page("wang-environment"))

    def test_search_steps_and_closed_holes(self):
        """Steps are counted in searches of the thesis. An open head is also measured with its hole closed, by three triangles here."""
        os.mkdir(self.path("models"))
        self.write("models/suzanne.obj", "".join(line + "\n" for line in TETRAHEDRON.splitlines()[:-1]))
        _, content = self.measure("wang-steps", "--models", "models", size="24x24")
        runs = {(run["scene"], run["variant"]): run for run in content["experiments"][0]["runs"]}
        for run in runs.values():
            searches = run["searches"]
            self.assertTrue(0.2 < searches["mean"] <= searches["largest"] < 5, run)
        self.assertLess(runs["sphere", "defaults"]["searches"]["mean"], 1.1)
        self.assertEqual([runs[head, "defaults"]["triangles"] for head in ("head (open)", "head, holes closed")], [3, 6])
        self.assertTrue(any("1 holes are closed" in warning for warning in content["experiments"][0]["warnings"]))

    def test_the_footprint_replaces_samples(self):
        _, content = self.measure("wang-footprint", size="64x64")
        errors = {run["variant"]: run["rmse"] for run in content["experiments"][0]["runs"]}
        self.assertEqual(len(errors), 6)
        self.assertLess(errors["1 sample, footprint 4x4"], 0.85 * errors["1 sample, one direction"])

    def test_several_objects(self):
        _, content = self.measure("wang-many-objects", size="48x48")
        runs = content["experiments"][0]["runs"]
        self.assertEqual([run["objects"] for run in runs], [2, 2, 5])
        for run in runs:
            self.assertGreater(run["covered"], 100)
            # What is exact does not depend on the last bits: no two surfaces coincide.
            self.assertGreater(run["self_within_1deg"], 0.98)

    def test_published_figures(self):
        """Table 4.1: a row for each model and distance, with the thesis's ratio beside ours."""
        _, content = self.measure("wang-table-4-1", size="32x32")
        ratios = {run["scene"]: run["published"]["ratio"] for run in content["experiments"][0]["runs"]}
        self.assertAlmostEqual(ratios["sphere, far"], 153 / 112)
        self.assertAlmostEqual(ratios["sphere, near"], 153 / 56)
        self.assertAlmostEqual(ratios["torus, near"], 142 / 49)
        self.assertAlmostEqual(ratios["infinity ring, far"], 133 / 79)
        self.assertIn("1.37", self.page("wang-table-4-1"))


class ThicknessExperiments(CliTest):
    def test_three_balls(self):
        """The paper's figure of merit: layers and peeling are nearly exact, a shadow map is far off, and the published forms lie
        between."""
        result = self.run_cli("experiment", "chen-error", "--size", "480x270", "--json", "e.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        runs = {(r["scene"], r["variant"]): r["relative_error"] for r in json.loads(self.read("e.json"))["experiments"][0]["runs"]}
        for view in (f"{light}, {side}" for light in ("sun", "lamp") for side in ("behind", "side", "top")):
            for method in ("layers", "depth-peeling", "dual-depth-peeling"):
                self.assertLess(runs[view, method + ", 1024"], 0.005, (view, method))
                self.assertLess(runs[view, method + ", 1024"], runs[view, "published-depth-peeling, 1024"], (view, method))
            self.assertLess(runs[view, "published-depth-peeling, 1024"], 0.005 if view.endswith("behind") else 0.3, view)
            for method in ("translucent-shadow-map, 1024", "published-shadow-map, 1024", "published-local-thickness"):
                self.assertGreater(runs[view, method], 0.3, (view, method))
            if view.startswith("sun"):
                self.assertLess(runs[view, "rays of Embree"], 0.005, view)

    def test_without_the_dragon(self):
        result = self.run_cli("experiment", "chen-speed", "--size", "64x64")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("nothing is left to measure", result.stderr)


class KayGreenbergExperiments(CliTest):
    def runs(self, name, size):
        result = self.run_cli("experiment", name, "--size", size, "--json", "e.json", "--validate")
        self.assertEqual(result.returncode, 0, result.stderr)
        return {(run["scene"], run["variant"]): run for run in json.loads(self.read("e.json"))["experiments"][0]["runs"]}

    def test_transparency(self):
        """The length in the slabs is the best form for an even wall; none sees the stem of a glass, or the cut of half a vase."""
        runs = self.runs("kay-greenberg-transparency", "64x64")
        self.assertEqual(len(runs), 4 * 5)
        for run in runs.values():
            self.assertGreater(run["pixels"], 400)
            self.assertTrue(0 < run["transparency"] < 1 and 0 < run["exact_transparency"] < 1)
        errors = {variant: run["error"] for (scene, variant), run in runs.items() if scene == "vase"}
        self.assertEqual(min(errors, key=errors.get), "refraction, T^d")
        self.assertLess(runs["vase", "refraction, T^d"]["median"], 0.01)
        self.assertGreater(errors["power 1"], errors["power 2"])
        self.assertGreater(errors["power 2"], errors["power 3"])
        for scene in ("thick half vase", "champagne glass, thin"):
            self.assertLess(runs[scene, "refraction, T^d"]["length_ratio"], 0.5)

    def test_background(self):
        """Section 4.3: errors grow with thickness and distance of the background, and a little with the field of view."""
        runs = self.runs("kay-greenberg-background", "64x64")
        walls, fields = ("0.01", "0.04", "0.12"), (1, 15, 30, 60, 90)
        self.assertEqual(len(runs), len(walls) * len(fields) * 2)
        for variant in ("linear", "refraction, T^d"):
            medians = {(wall, field): [runs[f"wall {wall} m, {field} degrees", variant][f"at_{distance}"]["median"]
                                       for distance in (0, 1, 4)] for wall in walls for field in fields}
            for median in medians.values():
                self.assertEqual(median, sorted(median))
            for field in fields:
                for distance in range(3):
                    of_walls = [medians[wall, field][distance] for wall in walls]
                    self.assertEqual(of_walls, sorted(of_walls))
            for wall in walls:
                self.assertLess(medians[wall, 1][2], medians[wall, 90][2])


class RayExperiments(CliTest):
    def test_smoothed_ball(self):
        """The finer the volume, the nearer to Snell's law; the shorter the step, the nearer to the curve."""
        result = self.run_cli("experiment", "ihrke-rays", "--size", "48x40", "--frames", "2", "--json", "e.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        runs = json.loads(self.read("e.json"))["experiments"][0]["runs"]
        surface = {(r["resolution"], r["smoothing"]): r for r in runs if "converged_mean_deg" not in r}
        self.assertEqual(sorted(surface), [(n, s) for n in (64, 128, 256) for s in (0.5, 0.75, 1.0)])
        for smoothing in (0.5, 0.75, 1.0):
            for measure in ("mean_deg", "median_deg"):
                errors = [surface[n, smoothing][measure] for n in (64, 128, 256)]
                self.assertEqual(errors, sorted(errors, reverse=True), (smoothing, measure))
        self.assertGreater(surface[256, 0.75]["within_5deg"], 0.9)
        steps = {(r["integrator"], r["step"]): r for r in runs if "converged_mean_deg" in r}
        self.assertEqual(len(steps), 8 + 5 + 6 + 5)
        for (integrator, step), run in steps.items():
            self.assertGreater(run["covered"], 300)
            self.assertGreater(run["converged_mean_deg"], 0)
            if "frame_ms" in run:
                self.assertGreater(run["frame_ms"], 0)
        for integrator in ("euler", "rk4", "leapfrog", "nystrom"):
            self.assertLess(steps[integrator, 0.125]["converged_mean_deg"], steps[integrator, 2.0]["converged_mean_deg"])
        for step in (0.125, 0.25, 0.5):
            self.assertLess(steps["rk4", step]["converged_mean_deg"], steps["euler", step]["converged_mean_deg"])
        if "frame_ms" in steps["rk4", 1.0]:
            equal = steps["rk4", 1.0]["euler_at_equal_error"]
            self.assertLess(equal["step"], 0.25)
            self.assertAlmostEqual(equal["times_as_long"], equal["frame_ms"] / steps["rk4", 1.0]["frame_ms"])
        table = self.read("out/experiments/ihrke-rays/ihrke-rays.md").decode()
        self.assertIn(f"{surface[64, 0.5]['mean_deg']:.3f}", table)


if __name__ == "__main__":
    cli.main()
