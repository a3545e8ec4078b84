"""What is written, and that it is whole or not there."""
import json
import math
import os
import signal
import subprocess
import unittest

import cli
from cli import BINARY, CliTest, TETRAHEDRON
from pictures import read_exr, read_png

AOVS = {"exit-direction": 3, "exit-position": 3, "path-length": 1, "events": 2, "status": 1, "layers": 1, "depth": 1,
        "normal": 3, "object": 1, "back-depth": 1, "back-normal": 3, "exit-object": 1, "emitted": 3, "direct": 3, "caustic": 3, "indirect": 3}
STATUS = ["ok", "missing_layer", "left_screen", "step_limit", "event_limit"]


def srgb(value):
    """IEC 61966-2-1."""
    value = min(max(value, 0.0), 1.0)
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


class Pictures(CliTest):
    def test_png(self):
        self.assert_rendered(self.render("shape:goblet", size="17x13"))
        picture = read_png(self.read("out.png"))
        self.assertEqual((picture.width, picture.height), (17, 13))
        self.assertGreater(len(set(picture.pixels)), 10)

    def test_exr(self):
        self.assert_rendered(self.render("shape:goblet", output="out.exr", size="17x33"), "out.exr")
        picture = read_exr(self.read("out.exr"))
        self.assertEqual((picture.width, picture.height, sorted(picture.channels)), (17, 33, ["B", "G", "R"]))
        self.assertTrue(all(math.isfinite(value) and value >= 0 for value in picture.pixels))
        self.assertGreater(max(picture.pixels), 0.1)

    def test_extension_in_capitals(self):
        self.assert_rendered(self.render("shape:sphere", output="OUT.PNG"), "OUT.PNG")
        read_png(self.read("OUT.PNG"))
        self.assert_rendered(self.render("shape:sphere", output="OUT.EXR"), "OUT.EXR")
        read_exr(self.read("OUT.EXR"))

    def test_tonemap_none_clips_and_encodes(self):
        self.assert_rendered(self.render("shape:goblet", output="out.exr"), "out.exr")
        linear = read_exr(self.read("out.exr"))
        for stops in (0, 1, -2):
            self.assert_rendered(self.render("shape:goblet", "--tonemap", "none", "--exposure", str(stops)))
            display = read_png(self.read("out.png"))
            for pixel in range(linear.width * linear.height):
                for i, channel in enumerate("RGB"):
                    radiance = linear.pixels[3 * pixel + linear.channels.index(channel)]
                    expected = 255 * srgb(radiance * 2.0 ** stops)
                    # Rounding, and one step for the device's own power function.
                    self.assertAlmostEqual(display.pixels[3 * pixel + i], expected, delta=1.0)

    def test_tonemaps_differ(self):
        pictures = set()
        for name in ("none", "reinhard", "aces", "neutral", "krawczyk"):
            self.assert_rendered(self.render("shape:goblet", "--tonemap", name))
            pictures.add(self.read("out.png"))
        self.assertEqual(len(pictures), 5)

    def test_same_twice(self):
        self.assert_rendered(self.render("shape:goblet"))
        first = self.read("out.png")
        self.assert_rendered(self.render("shape:goblet"))
        self.assertEqual(self.read("out.png"), first)


class Samples(CliTest):
    def render_samples(self, samples):
        self.assert_rendered(self.render("shape:goblet", "--samples", str(samples), "--aov", "exit-direction=direction.exr",
                                         "--json", "out.json"))
        return self.read("out.png"), read_exr(self.read("direction.exr")).pixels, json.loads(self.read("out.json"))

    def test_pictures_change_and_aovs_do_not(self):
        one_picture, one_aov, one = self.render_samples(1)
        more_picture, more_aov, more = self.render_samples(5)
        self.assertNotEqual(one_picture, more_picture)
        self.assertEqual(one_aov, more_aov)
        self.assertEqual((one["frames"], more["frames"]), (1, 5))
        self.assertEqual((one["layer_passes"], more["layer_passes"]), (1, 1))
        self.assertEqual((one["covered"], one["status"]), (more["covered"], more["status"]))


class LayerBuilders(CliTest):
    """`--layer-builder`: one picture, however its layers were gathered."""

    def test_pictures_are_the_same(self):
        pictures = set()
        for builder in ("single-pass", "depth-peeling", "dual-depth-peeling"):
            self.assert_rendered(self.render("shape:goblet", "--technique", "wang-2014", "--layer-builder", builder, "--json",
                                             "out.json"))
            pictures.add(self.read("out.png"))
            self.assertEqual(json.loads(self.read("out.json"))["layer_passes"] > 1, builder != "single-pass")
        self.assertEqual(len(pictures), 1)


class PathTraced(CliTest):
    """`--technique path`: an estimate, with what is known about its error."""

    def trace(self, *arguments, samples=4):
        self.assert_rendered(self.render("shape:sphere", "--technique", "path", "--samples", str(samples), "--environment",
                                         "checker", "--json", "out.json", *arguments, output="out.exr"), "out.exr")
        return read_exr(self.read("out.exr"))

    def test_channels(self):
        picture = self.trace(samples=8)
        self.assertEqual(sorted(picture.channels), ["B", "G", "R", "error.B", "error.G", "error.R", "samples"])
        count = len(picture.channels)
        channel = {name: picture.pixels[i::count] for i, name in enumerate(picture.channels)}
        self.assertEqual(set(channel["samples"]), {8.0})
        self.assertTrue(all(map(math.isfinite, picture.pixels)))
        self.assertGreater(max(channel["error.G"]), 0)
        self.assertLess(sum(channel["error.G"]), sum(channel["G"]))
        described = json.loads(self.read("out.json"))
        self.assertGreaterEqual(described["cut_paths"], 0)
        self.assertEqual(described["parameters"], {"events": 16, "seed": 1, "vertices": 256, "photons": 20000})

    def test_parts_add_up_and_flux_is_told(self):
        names = ("emitted", "direct", "caustic", "indirect")
        picture = self.trace("--add-light", "lamp:0,3,0,9,0.2", *(a for n in names for a in ("--aov", f"{n}={n}.exr")))
        parts = [read_exr(self.read(f"{name}.exr")).pixels for name in names]
        for c, own in (("R", "R"), ("G", "G"), ("B", "B")):
            whole = picture.pixels[picture.channels.index(c)::len(picture.channels)]
            summed = [sum(values) for values in zip(*(part["BGR".index(own)::3] for part in parts))]
            self.assertTrue(all(math.isclose(a, b, rel_tol=1e-4, abs_tol=1e-4) for a, b in zip(whole, summed)))
        flux = json.loads(self.read("out.json"))["light_flux"]
        self.assertEqual([sorted(entry) for entry in flux], [["direct_w", "object", "photons_w"]])

    def test_other_views_have_no_parts(self):
        run = self.render("shape:sphere", "--view", "analysis", "--aov", "direct=direct.exr")
        self.assertEqual(run.returncode, 2)
        self.assertIn("'direct'", run.stderr)
        self.assertIn("radiance", run.stderr)

    def test_light_that_needs_photons_is_told(self):
        run = self.render("shape:sphere", "--technique", "path", "--photons", "0", "--add-light", "lamp:0,3,0,9")
        self.assertEqual(run.returncode, 0)
        self.assertIn("1 light is without a size", run.stderr)

    def test_depends_on_the_seed_and_not_on_the_threads(self):
        first = self.trace("--threads", "1").pixels
        self.assertEqual(self.trace("--threads", "2").pixels, first)
        self.assertNotEqual(self.trace("--seed", "2").pixels, first)

    def test_other_techniques_have_no_error_channels(self):
        self.assert_rendered(self.render("shape:sphere", "--technique", "reference", output="out.exr"), "out.exr")
        self.assertEqual(sorted(read_exr(self.read("out.exr")).channels), ["B", "G", "R"])


class Adaptive(CliTest):
    """`--error X`: each pixel has the samples that it needs."""

    def test_counts(self):
        self.assert_rendered(self.render("shape:torus", "--environment", "checker", "--error", "0.2", "--most-samples", "20",
                                         "--json", "out.json", output="out.exr", size="32x32"), "out.exr")
        picture = read_exr(self.read("out.exr"))
        self.assertEqual(sorted(picture.channels), ["B", "G", "R", "samples"])
        counts = picture.pixels[picture.channels.index("samples")::4]
        described = json.loads(self.read("out.json"))
        self.assertEqual((min(counts), max(counts)), (4, described["most_samples"]))
        self.assertAlmostEqual(described["samples"], sum(counts) / len(counts), places=4)
        self.assertAlmostEqual(described["error"], 0.2)

    def test_refused(self):
        self.refuses("--error", "--error", "0.1", "--samples", "4")
        self.refuses("--error", "--most-samples", "4")
        self.refuses("--error", "--error", "-1")
        self.refuses("most samples", "--error", "1", "--most-samples", "0")


class Difference(CliTest):
    """`pellucid difference`: pictures of whatever renderer."""

    def setUp(self):
        super().setUp()
        for name, technique in (("a", "reference"), ("b", "one-interface")):
            for extension in ("exr", "png"):
                self.assert_rendered(self.render("shape:sphere", "--technique", technique, "--aov", f"events={name}-events.exr",
                                                 output=f"{name}.{extension}", size="32x32"), f"{name}.{extension}")

    def difference(self, *arguments):
        result = self.run_cli("difference", *arguments, "--json", "difference.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(self.read("difference.json"))

    def test_numbers(self):
        for extension in ("exr", "png"):
            same = self.difference(f"a.{extension}", f"a.{extension}")
            self.assertEqual((same["pixels"], same["flip_mean"], same["rmse"]), (32 * 32, 0, 0))
            whole = self.difference(f"a.{extension}", f"b.{extension}")
            glass = self.difference(f"a.{extension}", f"b.{extension}", "--mask", "a-events.exr")
            self.assertLess(glass["pixels"], whole["pixels"])
            # All of the difference is in the glass.
            self.assertAlmostEqual(glass["rmse"] ** 2 * glass["pixels"], whole["rmse"] ** 2 * whole["pixels"], delta=1e-3)
            self.assertGreater(glass["flip_mean"], whole["flip_mean"])

    def test_the_map_is_what_the_mean_is_of(self):
        found = self.difference("a.exr", "b.exr", "--exposure", "1", "--map", "map.exr")
        pixels = read_exr(self.read("map.exr")).pixels
        self.assertAlmostEqual(found["flip_mean"], sum(pixels) / len(pixels), places=5)

    def test_refused(self):
        for words, arguments in ((("encoded",), ("a.exr", "b.png")), (("nothing.exr",), ("a.exr", "nothing.exr")),
                                 (("--exposure",), ("a.png", "b.png", "--exposure", "1")),
                                 (("pixels",), ("a.exr", "b.exr", "--mask", "small.exr")),
                                 (("a.exr",), ("a.exr", "b.exr", "--map", "a.exr"))):
            self.render("shape:sphere", output="small.exr", size="8x8")
            with self.subTest(arguments=arguments):
                self.assert_refused(self.run_cli("difference", *arguments), *words)


class Aovs(CliTest):
    def test_each(self):
        arguments = [argument for name in AOVS for argument in ("--aov", f"{name}={name}.exr")]
        self.assert_rendered(self.render("shape:goblet", *arguments, "--json", "out.json", size="19x18"))
        aovs = {name: read_exr(self.read(f"{name}.exr")) for name in AOVS}
        for name, aov in aovs.items():
            self.assertEqual((aov.width, aov.height, len(aov.channels)), (19, 18, AOVS[name]), name)
            self.assertTrue(all(map(math.isfinite, aov.pixels)), name)
        self.check_counts(aovs, json.loads(self.read("out.json")))

    def check_counts(self, aovs, described):
        """The counts of the JSON are those of the AOVs."""
        interfaces = aovs["events"].pixels[aovs["events"].channels.index("Y")::2]
        covered = [i for i, count in enumerate(interfaces) if count > 0]
        self.assertGreater(len(covered), 10)
        self.assertEqual(described["covered"], len(covered))
        for number, name in enumerate(STATUS):
            share = sum(aovs["status"].pixels[i] == number for i in covered) / len(covered)
            self.assertAlmostEqual(described["status"][name], share, places=9)
        for i in covered:
            self.assertAlmostEqual(math.hypot(*aovs["exit-direction"].pixels[3 * i:3 * i + 3]), 1, places=3)
            self.assertGreater(aovs["depth"].pixels[i], 0)

    def test_deeper_surfaces(self):
        """Of four layers of a torus: each lies behind the one before, the back faces are the even ones, and what is not recorded is
        refused."""
        names = [f"{kind}{layer}" for kind in ("depth", "normal", "object") for layer in ("", "-2", "-3", "-4")] + ["back-depth", "back-normal"]
        arguments = [argument for name in names for argument in ("--aov", f"{name}={name}.exr")]
        self.assert_rendered(self.render("shape:torus", "--technique", "wang-2014", "--layers", "4", "--camera", "orbit:80,5,3",
                                         *arguments, size="32x24"))
        aovs = {name: read_exr(self.read(f"{name}.exr")).pixels for name in names}
        depths = list(zip(*(aovs[name] for name in ("depth", "depth-2", "depth-3", "depth-4"))))
        four = [i for i, along in enumerate(depths) if along[3] > 0]
        self.assertGreater(len(four), 20)
        for i, along in enumerate(depths):
            known = [depth for depth in along if depth > 0]
            self.assertEqual(known, sorted(known))
            self.assertEqual(aovs["back-depth"][i], along[3] or along[1])
            self.assertEqual([aovs[f"object{layer}"][i] for layer in ("", "-2", "-3", "-4")], [0 if depth > 0 else -1 for depth in along])
        for i in four:
            self.assertEqual(aovs["back-normal"][3 * i:3 * i + 3], aovs["normal-4"][3 * i:3 * i + 3])
            self.assertAlmostEqual(math.hypot(*aovs["normal-3"][3 * i:3 * i + 3]), 1, places=3)
        for technique, name in (("wang-2014", "depth-5"), ("one-interface", "normal-2"), ("reference", "object-2")):
            arguments = ("--layers", "4") if technique == "wang-2014" else ()
            self.refuses(name, "--technique", technique, *arguments, "--aov", f"{name}=a.exr")
        for name in ("depth-1", "depth-0", "depth-", "depth-02", "depth-x", "depth-99999999999", "events-2"):
            self.refuses(["unknown AOV", name], "--aov", f"{name}=a.exr")

    def test_list_is_complete(self):
        self.assertEqual(sorted(self.known_names("--aov", "?=out.exr")), sorted(AOVS))

    def test_syntax(self):
        for aov in ("depth", "depth=", "depth=a.png", "depth=a", "depth=.exr", "=a.exr", ""):
            self.refuses("AOV" if aov == "=a.exr" else "--aov", "--aov", aov)


class Json(CliTest):
    def describe(self, scene, *arguments):
        self.assert_rendered(self.render(scene, "--json", "out.json", *arguments))
        return json.loads(self.read("out.json"))

    def test_content(self):
        described = self.describe("shape:sphere", "--samples", "3")
        for key in ("device", "driver", "version"):
            self.assertTrue(described[key], key)
        self.assertEqual(described["version"], self.run_cli("--version").stdout.strip())
        self.assertEqual((described["width"], described["height"]), (16, 16))
        self.assertGreater(described["triangles"], 100)
        self.assertEqual(described["origin"], [0, 0, 0])
        self.assertGreater(described["covered"], 0)
        self.assertEqual(list(described["status"]), STATUS)
        self.assertAlmostEqual(sum(described["status"].values()), 1)
        self.assertEqual(described["warnings"], [])
        self.assertLessEqual({"layers", "trace", "shade"}, set(described["passes"]))
        for times in described["passes"].values():
            self.assertGreaterEqual(times["median"], 0)
        self.assertAlmostEqual(described["frame_ms"], sum(times["median"] for times in described["passes"].values()))

    def test_warnings(self):
        self.write("open.obj", TETRAHEDRON[:TETRAHEDRON.rindex("f")])
        described = self.describe("open.obj")
        self.assertEqual(described["triangles"], 3)
        self.assertRegex(" ".join(described["warnings"]), r"open.*3.*edge|3 .*edge.*open")


class Unwritable(CliTest):
    """Outputs that cannot be written are refused, and then none is."""

    def test_picture(self):
        os.mkdir(self.path("folder.png"))
        self.write("file", "")
        self.refuses(["folder.png", "is a folder"], output="folder.png")
        self.refuses(["no/out.png", "no folder"], output="no/out.png")
        self.refuses(["file/out.png", "not a folder"], output="file/out.png")
        self.refuses("/proc/out.png", output="/proc/out.png")
        for name in ("out.jpg", "out", "out.png.bak", ".png"):
            self.refuses([f"'{name}'", ".png", ".exr"], output=name)

    def test_others(self):
        self.refuses(["no/a.exr", "no folder"], "--aov", "depth=no/a.exr")
        self.refuses(["no/a.json", "no folder"], "--json", "no/a.json")
        self.refuses([".", "folder"], "--json", ".")

    def test_devices_are_not_replaced(self):
        self.refuses(["/dev/full", "not a regular file"], "--json", "/dev/full")

    @unittest.skipIf(os.geteuid() == 0, "root may write into every folder")
    def test_read_only_folder(self):
        os.mkdir(self.path("locked"), 0o555)
        self.refuses(["locked/out.png", "Permission denied"], output="locked/out.png")

    def test_two_outputs_of_one_name(self):
        self.refuses(["./a.exr", "two outputs"], "--aov", "depth=a.exr", "--aov", "normal=./a.exr")
        self.refuses(["out.exr", "two outputs"], "--aov", "depth=out.exr", output="out.exr")
        self.refuses([self.path("out.png"), "two outputs"], "--json", self.path("out.png"))

    def test_input_is_not_overwritten(self):
        self.write("a.obj", TETRAHEDRON)
        self.refuses(["a.obj", "overwrite"], "--json", "a.obj", scene="a.obj")
        self.assertEqual(self.read("a.obj").decode(), TETRAHEDRON)

    def test_link_stays(self):
        self.write("real.png", "old")
        os.symlink("real.png", self.path("link.png"))
        self.assert_rendered(self.render("shape:sphere", output="link.png"), "link.png")
        self.assertTrue(os.path.islink(self.path("link.png")))
        read_png(self.read("real.png"))


class Killed(CliTest):
    def start(self, *arguments):
        process = subprocess.Popen([BINARY, "render", "shape:sphere", "-o", "out.exr", *arguments], cwd=self.folder)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_while_rendering(self):
        process = self.start("--size", "64x64", "--samples", "1000000")
        with self.assertRaises(subprocess.TimeoutExpired):
            process.wait(timeout=1)
        process.kill()
        self.assertEqual(process.wait(), -signal.SIGKILL)
        self.assertEqual(self.files(), [])

    def test_while_writing(self):
        process = self.start("--size", "1500x1500", "--technique", "one-interface")
        while process.poll() is None and not self.files():
            pass
        process.kill()
        process.wait()
        if "out.exr" in self.files():  # the kill came too late: the file is whole
            read_exr(self.read("out.exr"))

    def test_old_file_stays(self):
        self.write("out.exr", "old")
        process = self.start("--size", "1500x1500", "--technique", "one-interface")
        while process.poll() is None and self.files() == ["out.exr"]:
            pass
        process.kill()
        process.wait()
        if self.read("out.exr") != b"old":
            read_exr(self.read("out.exr"))


if __name__ == "__main__":
    cli.main()
