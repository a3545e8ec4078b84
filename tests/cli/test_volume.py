"""Volumes of varying index: made, written, mapped, placed, and what is refused."""
import json
import re

import cli
from cli import CliTest
from test_scenes import GLTF

LENS = "volume:luneburg,resolution=16"


def gltf_with_volume(volume, **node):
    return json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                       "nodes": [{"name": "lens", "extras": {"pellucid_volume": volume}, **node}]})


class VolumeHelpers:
    def make(self, source, *arguments, output="out.vdb"):
        result = self.run_cli("volume", source, "-o", output, *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def refuses_to_make(self, words, source, *arguments, output="out.vdb"):
        before = self.files()
        with self.subTest(source=source, arguments=arguments):
            self.assert_refused(self.run_cli("volume", source, "-o", output, *arguments), *words)
            self.assertEqual(self.files(), before)

    def info(self, *arguments):
        result = self.run_cli("info", *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout


class VolumeFiles(VolumeHelpers, CliTest):
    def test_made_volumes_are_written_and_drawn(self):
        described = self.make(LENS)
        self.assertRegex(described, r"(?m)^luneburg: 16 x 16 x 16 voxels of ")
        self.assertRegex(described, r"(?m)^n: 1 to 1\.4")
        # The file is what it was made from.
        again = self.make("out.vdb", output="again.vdb")
        self.assertEqual(again.partition(":")[2], described.partition(":")[2])
        self.assert_rendered(self.render("out.vdb", "--json", "out.json"))
        self.assertGreater(json.loads(self.read("out.json"))["covered"], 50)

    def test_how_files_are_written(self):
        made = self.make(LENS)
        self.make(LENS, "--uncompressed", output="plain.vdb")
        self.make(LENS, "--double", "--uncompressed", output="double.vdb")
        compressed, plain, double = (len(self.read(name)) for name in ("out.vdb", "plain.vdb", "double.vdb"))
        self.assertLess(compressed, plain)
        self.assertGreater(double, 1.7 * plain)
        self.assertEqual(self.make("double.vdb", output="again.vdb").partition(":")[2], made.partition(":")[2])

    def test_smoothing(self):
        ball = "volume:smoothed-sphere,resolution=24,smoothing=0.25"
        sharp = self.make(ball)
        smooth = self.make(ball, "--smoothing", "8")
        self.assertIn("n: 1 to 1.5\n", sharp)
        self.assertLess(float(re.search(r"(?m)^n: \S+ to (\S+)", smooth)[1]), 1.45)

    def test_glass_becomes_voxels(self):
        described = self.make("shape:sphere", "--resolution", "32", "--validate", "--ior", "1.7")
        self.assertRegex(described, r"(?m)^n: 1 to 1\.7$")
        self.assertNotIn("sigma_s", described)
        described = self.make("shape:sphere", "--resolution", "24", "--scattering", "3", "--mean-cosine", "0.5",
                              "--noise", "1", "--coverage-samples", "2", "--smoothing", "0")
        self.assertRegex(described, r"24 x 24 x 24 voxels")
        self.assertRegex(described, r"(?m)^g: 0\.5 to 0\.5$")
        self.assertGreater(float(re.search(r"(?m)^sigma_s: .* to \((\S+),", described)[1]), 3.2)

    def test_grids_of_other_tools(self):
        self.make("volume:smoke,resolution=16", output="smoke.vdb")
        described = self.make("smoke.vdb", "--map", "sigma_s=sigma_a:2", "--map", "g=emission")
        own = self.info("smoke.vdb")
        self.assertEqual(own.splitlines()[1], self.info("out.vdb").splitlines()[1])
        self.assertNotIn("sigma_s", described)
        self.assertIn("sigma_a", described)
        self.assertRegex(described, r"emission: .*0\.4, 0\.4, 0\.4")

    def test_what_is_refused(self):
        self.make(LENS)
        self.write("empty.vdb", "")
        self.write("garbage.vdb", bytes(range(256)) * 64)
        self.write("cut.vdb", self.read("out.vdb")[:-2000])
        for name, word in (("nowhere.vdb", "no such file"), ("empty.vdb", "empty"), ("garbage.vdb", "garbage.vdb"),
                           ("cut.vdb", "cut.vdb")):
            self.refuses_to_make([name, word], name, output="new.vdb")
            self.refuses([name, word], scene=name)
        self.refuses_to_make(["luneberg", "luneburg"], "volume:luneberg", output="new.vdb")
        self.refuses_to_make(["radius"], "volume:luneburg,radius=-1", output="new.vdb")
        self.refuses_to_make(["voxels need"], "volume:luneburg,resolution=60000", output="new.vdb")
        self.refuses_to_make(["out.png", ".vdb"], LENS, output="out.png")
        self.refuses_to_make(["overwrite"], "out.vdb", output="out.vdb")
        self.refuses_to_make(["voxels need"], "shape:sphere", "--resolution", "60000", output="new.vdb")
        self.refuses_to_make(["resolution"], "shape:sphere", "--resolution", "2", output="new.vdb")
        self.refuses_to_make(["smoothing"], "shape:sphere", "--smoothing", "-1", output="new.vdb")
        self.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n")
        self.refuses_to_make(["open.obj", "not closed"], "open.obj", output="new.vdb")
        self.refuses_to_make(["GRID=FIELD"], "out.vdb", "--map", "n", output="new.vdb")
        self.refuses_to_make(["density"], "out.vdb", "--map", "density=n", output="new.vdb")
        self.refuses_to_make(["grids"], LENS, "--map", "n=n", output="new.vdb")
        self.refuses_to_make(["volumes already"], "shape:sphere", "--add-volume", LENS, output="new.vdb")


class PlacedVolumes(VolumeHelpers, CliTest):
    def test_added_ones_stand_beside_the_scene(self):
        self.make("volume:smoke,resolution=8", output="smoke.vdb")
        added = ["--add-volume", f"{LENS}@3,0,0,0.5", "--add-volume", "smoke.vdb@-3,0.5,0"]
        described = self.info("shape:sphere", *added, "--map", "sigma_s=sigma_a")
        self.assertIn("volume: luneburg, 16 x 16 x 16 voxels", described)
        self.assertIn("volume: smoke, 8 x 8 x 8 voxels", described)
        self.assertIn("box: -4 -1 -1 to 3.53125 1.5 1 m", described)
        self.assert_rendered(self.render("shape:sphere", *added, "--json", "out.json"))
        self.assertEqual(json.loads(self.read("out.json"))["stands_for"], "ihrke-2007")

    def test_bad_placements(self):
        for placement, word in ((f"{LENS}@1,2", "1,2"), (f"{LENS}@1,2,3,0", "scale"), (f"{LENS}@1,2,3,-1", "scale"),
                                (f"{LENS}@1,2,3,4,5", "1,2,3,4,5"), (f"{LENS}@x,2,3", "x"), ("volume:lens", "lens"),
                                ("nowhere.vdb@0,0,0", "nowhere.vdb"), ("shape:cube", "shape:cube")):
            self.refuses(word, "--add-volume", placement)
        self.refuses("grids", "--add-volume", LENS, "--map", "n=n")

    def test_nodes_of_gltf_name_volumes(self):
        self.make(LENS, output="lens.vdb")
        for source in (LENS, "lens.vdb"):
            self.write("a.gltf", gltf_with_volume(source, translation=[1, 2, 3], scale=[2, 2, 2]))
            described = self.info("a.gltf")
            self.assertIn("volume: lens, 16 x 16 x 16 voxels", described)
            self.assertIn("box: -1.125 -0.125 0.875 to 3.125 4.125 5.125 m", described)
        self.assert_rendered(self.render("a.gltf"))
        for volume, word in ((7, "string"), ("lens.obj", "lens.obj"), ("gone.vdb", "no such file"),
                             ("volume:lens", "unknown volume")):
            self.write("bad.gltf", gltf_with_volume(volume))
            self.refuses(["bad.gltf: lens: pellucid_volume", word], scene="bad.gltf")
        self.write("bad.gltf", gltf_with_volume(LENS, scale=[1, 2, 1]))
        self.refuses(["bad.gltf: lens", "alike"], scene="bad.gltf")

    def test_wavefronts_need_light_and_volumes(self):
        self.refuses("view wavefront: the scene has no lights", "--view", "wavefront", scene=LENS)
        self.refuses("traces no wavefronts", "--view", "wavefront", "--technique", "wang-2014")

    def test_other_techniques_say_that_they_draw_none(self):
        self.write("a.gltf", json.dumps({**GLTF, "nodes": [{**GLTF["nodes"][0], "extras": {"pellucid_volume": LENS}},
                                                           GLTF["nodes"][1]]}))
        result = self.render("a.gltf", "--technique", "wang-2014")
        self.assert_rendered(result)
        self.assertRegex(result.stderr, r"(?m)^pellucid: warning: [^\n]*volume")


if __name__ == "__main__":
    cli.main()
