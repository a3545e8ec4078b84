"""Files for other programs: `pellucid export` by round trips, and multilayer EXR as Blender reads it."""
import json
import os
import shutil
import subprocess
import unittest
from pathlib import Path

import cli
from cli import CliTest

DATA = Path(os.environ.get("PELLUCID_TEST_DATA", "/nonexistent")) / "gltf"
VIEW = ("--camera", "orbit:30,20,4", "--quiet")


class Export(CliTest):
    def export(self, scene, output, *arguments):
        result = self.run_cli("export", scene, "-o", output, *arguments)
        self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
        return result.stderr

    def distance(self, one, other, *arguments):
        """RMSE between the images of two scenes."""
        for scene, output in ((one, "one.exr"), (other, "other.exr")):
            self.assert_rendered(self.render(scene, *(arguments or VIEW), output=output, size="40x40"), output)
        result = self.run_cli("difference", "one.exr", "other.exr", "--json", "difference.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(self.read("difference.json"))["rmse"]

    def test_glass_by_both(self):
        glass = ("--ior", "1.6", "--attenuation-color", "0.9,0.5,0.2", "--attenuation-distance", "0.5")
        for file in ("a.glb", "a.obj"):
            said = self.export("shape:goblet", file, *glass)
            self.assertEqual("attenuation left out" in said, file == "a.obj", said)
        self.export("shape:goblet", "clear.obj")
        self.assertLess(self.distance("shape:goblet", "clear.obj"), 1e-6)
        self.assert_rendered(self.render("a.glb", *VIEW, output="one.exr", size="40x40"), "one.exr")
        self.assert_rendered(self.render("shape:goblet", *VIEW, *glass, output="two.exr", size="40x40"), "two.exr")
        self.run_cli("difference", "one.exr", "two.exr", "--json", "d.json")
        self.assertLess(json.loads(self.read("d.json"))["rmse"], 1e-6)

    def test_lights_and_priority(self):
        self.write("a.obj", cli.TETRAHEDRON)
        lights = ("--add-light", "sun:30,40", "--add-light", "lamp:1,2,3,20,0.1", "--add-light", "spot:1,1,3,0,0,0,30,5")
        self.export("a.obj", "a.glb", *lights, "--translucent", "0.5,0.6,0.7,1", "--priority", "a=3")
        info = json.loads(self.run_cli("info", "a.glb", "--json").stdout)
        self.assertEqual(len(info["lights"]), 3)
        self.assert_rendered(self.render("a.obj", *VIEW, *lights, "--translucent", "0.5,0.6,0.7,1", output="one.exr"), "one.exr")
        self.assert_rendered(self.render("a.glb", *VIEW, output="two.exr"), "two.exr")
        self.run_cli("difference", "one.exr", "two.exr", "--json", "d.json")
        self.assertLess(json.loads(self.read("d.json"))["rmse"], 1e-6)

    def test_far_from_the_origin(self):
        self.write("far.obj", "".join(f"v {431000.125 + x} {5412000.5 + y} {120.25 + z}\n" for x, y, z in
                                      ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))) + cli.TETRAHEDRON[cli.TETRAHEDRON.index("f"):])
        for file in ("a.glb", "a.obj"):
            self.export("far.obj", file)
            self.assertLess(self.distance("far.obj", file), 1e-6, file)
            boxes = [json.loads(self.run_cli("info", scene, "--json").stdout)["box_m"] for scene in ("far.obj", file)]
            self.assertEqual(*boxes)

    def test_models(self):
        names = ("MosquitoInAmber", "TextureTransformTest", "SimpleInstancing", "ClearCoatTest", "AnimatedMorphCube", "ToyCar")
        tested = 0
        for name in names:
            found = sorted([*DATA.glob(f"{name}/**/*.gltf"), *DATA.glob(f"{name}/**/*.glb")])
            if not found:
                continue
            with self.subTest(name):
                self.export(str(found[0]), "a.glb")
                self.assertLess(self.distance(str(found[0]), "a.glb"), 1e-4)
                tested += 1
        if not tested:
            self.skipTest("no model of glTF in PELLUCID_TEST_DATA")

    def test_pose(self):
        found = sorted([*DATA.glob("AnimatedMorphCube/**/*.gl[tb]*")])
        if not found:
            self.skipTest("AnimatedMorphCube is not in PELLUCID_TEST_DATA")
        said = self.export(str(found[0]), "a.glb", "--time", "1")
        self.assertIn("animations left out", said)
        boxes = [json.loads(self.run_cli("info", *scene, "--json").stdout)["box_m"] for scene in
                 ((str(found[0]), "--time", "1"), ("a.glb",))]
        self.assertEqual(*boxes)

    def test_refused(self):
        for words, output in ((".glb, .obj", "a.fbx"), ("there is no folder", "no/a.glb"), (".glb, .obj", "a")):
            self.assert_refused(self.run_cli("export", "shape:cube", "-o", output), words)
        self.assert_refused(self.run_cli("export", "volume:smoke", "-o", "a.glb"), "without objects")
        self.write("a.obj", cli.TETRAHEDRON)
        self.assert_refused(self.run_cli("export", "a.obj", "-o", "a.obj"), "would overwrite")
        self.assertEqual(self.files(), ["a.obj"])


class Layers(CliTest):
    NAMES = "depth,normal,events,object"
    IN_BLENDER = """
import bpy, json, sys
bpy.context.scene.use_nodes = True
image = bpy.data.images.load(sys.argv[-1])
node = bpy.context.scene.node_tree.nodes.new("CompositorNodeImage")
node.image = image
print("FOUND", json.dumps({"type": image.type, "outputs": [(o.name, o.type) for o in node.outputs if o.enabled]}))
"""

    def test_channels(self):
        from pictures import read_exr
        self.assert_rendered(self.render("shape:sphere", "--multilayer", self.NAMES, "--aov", "depth=d.exr", output="a.exr"), "a.exr")
        image, depth = read_exr(self.read("a.exr")), read_exr(self.read("d.exr"))
        self.assertEqual(set(image.channels), {"R", "G", "B", "depth.Z", "normal.X", "normal.Y", "normal.Z", "events.X", "events.Y",
                                               "object.X"})
        at = image.channels.index("depth.Z")
        self.assertEqual(list(image.pixels[at::len(image.channels)]), list(depth.pixels))

    def test_of_the_path_tracer(self):
        from pictures import read_exr
        self.assert_rendered(self.render("shape:sphere", "--technique", "path", "--samples", "2", "--multilayer", "depth",
                                         output="a.exr"), "a.exr")
        self.assertEqual(set(read_exr(self.read("a.exr")).channels),
                         {"R", "G", "B", "error.R", "error.G", "error.B", "samples.X", "depth.Z"})

    def test_refused(self):
        self.refuses("only .exr has layers", "--multilayer", "depth")
        self.refuses("did you mean depth?", "--multilayer", "dept", output="a.exr")

    @unittest.skipUnless(shutil.which("blender"), "Blender is not installed")
    def test_blender_finds_the_layers(self):
        self.assert_rendered(self.render("shape:sphere", "--multilayer", self.NAMES, output="a.exr"), "a.exr")
        self.write("look.py", self.IN_BLENDER)
        result = subprocess.run(["blender", "--background", "--factory-startup", "--python", self.path("look.py"), "--", self.path("a.exr")],
                                cwd=self.folder, capture_output=True, text=True, timeout=200)
        lines = [line for line in result.stdout.splitlines() if line.startswith("FOUND ")]
        self.assertEqual(len(lines), 1, result.stdout + result.stderr)
        found = json.loads(lines[0].removeprefix("FOUND "))
        self.assertEqual(found["type"], "MULTILAYER")
        outputs = dict(found["outputs"])
        self.assertLessEqual({"Combined", *self.NAMES.split(",")}, set(outputs), found)
        self.assertEqual((outputs["depth"], outputs["normal"]), ("VALUE", "RGBA"), "of three channels Blender makes colours")


if __name__ == "__main__":
    cli.main()
