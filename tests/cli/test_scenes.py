"""Scene files that are missing, damaged or strange."""
import base64
import json
import math
import os
import struct

import cli
from cli import CliTest, TETRAHEDRON
from pictures import read_exr

GLTF = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "name": "front", "translation": [0.3, 0.3, 3]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,"
                     "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}


def gltf(**changes):
    return json.dumps({**GLTF, **changes})


class FilesOutside(CliTest):
    def setUp(self):
        super().setUp()
        os.mkdir(self.path("scene"))
        self.write("b.bin", base64.b64decode(GLTF["buffers"][0]["uri"].split(",")[1]))
        self.write("m.mtl", "newmtl m\nKd 1 0 0\n")

    def refuse_unless_allowed(self, scene, name):
        self.assert_refused(self.run_cli("info", scene), scene, name, "--allow-outside")
        self.assertEqual(self.run_cli("info", scene, "--allow-outside").returncode, 0)

    def test_a_buffer_is_refused_by_name(self):
        for uri in ("../b.bin", "%2e%2e/b.bin", self.path("b.bin")):
            self.write("scene/a.gltf", gltf(buffers=[{"byteLength": 36, "uri": uri}]))
            self.refuse_unless_allowed("scene/a.gltf", "b.bin")

    def test_a_material_library_is_refused_by_name(self):
        self.write("scene/a.obj", "mtllib ../m.mtl\nusemtl m\n" + TETRAHEDRON)
        result = self.run_cli("info", "scene/a.obj")
        self.assert_refused(result, "m.mtl", "--allow-outside")
        self.assertEqual(self.run_cli("info", "scene/a.obj", "--allow-outside").returncode, 0)


class MemoryShare(CliTest):
    def test_a_scene_beyond_it_is_refused(self):
        self.write("a.obj", TETRAHEDRON * 1000)
        environment = dict(os.environ, PELLUCID_MEMORY_SHARE="0.000001")
        self.assert_refused(self.run_cli("info", "a.obj", env=environment), "a.obj", "PELLUCID_MEMORY_SHARE")


class SceneFiles(CliTest):
    def test_made_files_render(self):
        for name, content in (("a.obj", TETRAHEDRON), ("a.gltf", gltf())):
            with self.subTest(name):
                self.assert_rendered(self.render(self.write(name, content)))

    def test_missing(self):
        for name in ("nowhere.obj", "nowhere.gltf", "nowhere.glb", "no/where.ply"):
            self.refuses([name, "no such file"], scene=name)
        os.mkdir(self.path("folder.obj"))
        self.refuses(["folder.obj", "folder"], scene="folder.obj")

    def test_unknown_kind(self):
        self.write("scene.txt", "hello")
        self.refuses(["scene.txt", ".gltf", ".obj"], scene="scene.txt")

    def test_empty(self):
        for extension in ("obj", "ply", "stl", "off", "3ds", "gltf", "glb"):
            name = self.write(f"empty.{extension}", "")
            self.refuses([name, "is empty"], scene=name)

    def test_garbage(self):
        for extension in ("obj", "ply", "stl", "off", "3ds", "gltf", "glb"):
            name = self.write(f"garbage.{extension}", bytes(range(256)) * 4)
            self.refuses(name, scene=name)

    def test_truncated(self):
        name = self.write("cut.gltf", gltf()[:-40])
        self.refuses(name, scene=name)
        name = self.write("cut.off", "OFF\n4 4 6\n0 0 0\n1 0")
        self.refuses(name, scene=name)

    def test_malformed(self):
        for content in (TETRAHEDRON + "f 1 2 99\n", TETRAHEDRON.replace("v 1 0 0", "v nan 0 0"), "v 0 0 0\n",
                        "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"):
            name = self.write("bad.obj", content)
            self.refuses(name, scene=name)

    def test_missing_buffer(self):
        self.write("a.gltf", gltf(buffers=[{"byteLength": 36, "uri": "gone.bin"}]))
        self.refuses(["a.gltf", "gone.bin", "no such file"], scene="a.gltf")

    def test_required_extension(self):
        name = "KHR_gaussian_splatting"
        self.write("a.gltf", gltf(extensionsRequired=[name], extensionsUsed=[name]))
        self.refuses(["a.gltf", name], scene="a.gltf")

    def test_ignored_extension_is_a_warning(self):
        self.write("a.gltf", gltf(extensionsUsed=["ADOBE_materials_clearcoat_tint"]))
        result = self.render("a.gltf", "--json", "out.json")
        self.assert_rendered(result)
        self.assertRegex(result.stderr, r"(?m)^pellucid: warning: [^\n]*ADOBE_materials_clearcoat_tint")
        self.assertEqual(result.stderr.count("ADOBE_materials_clearcoat_tint"), 1)
        self.assertIn("ADOBE_materials_clearcoat_tint", " ".join(json.loads(self.read("out.json"))["warnings"]))

    def test_solid(self):
        corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
        triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        numbers = b"".join(struct.pack("<3f", *corners[v]) for t in triangles for v in t)
        self.write("a.gltf", gltf(
            accessors=[{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 36}],
            meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            materials=[{"name": "ice", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}],
            bufferViews=[{"buffer": 0, "byteLength": len(numbers)}],
            buffers=[{"byteLength": len(numbers), "uri": "data:;base64," + base64.b64encode(numbers).decode()}]))
        hint = self.run_cli("info", "a.gltf")
        self.assertRegex(hint.stderr, r"\Apellucid: warning: material ice: [^\n]*--solid[^\n]*\n\Z")
        solid = self.run_cli("info", "a.gltf", "--solid")
        self.assertEqual((solid.returncode, solid.stderr), (0, ""))
        self.assert_rendered(self.render("a.gltf"))
        thin = self.read("out.png")
        self.assert_rendered(self.render("a.gltf", "--solid"))
        self.assertNotEqual(thin, self.read("out.png"))

    def test_names_need_not_be_utf8(self):
        name = os.fsdecode(b"gla\xdf.obj")
        self.write(name, TETRAHEDRON)
        self.assert_rendered(self.render(name, "--json", "out.json"))
        json.loads(self.read("out.json").decode())


class Animations(CliTest):
    """A triangle that "slide" moves away from where the camera looks, in 2 s, and "rest" leaves alone."""

    def animated(self, **changes):
        numbers = struct.pack("<9f2f6f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 9, 0, 0)
        views = [{"buffer": 0, "byteOffset": start, "byteLength": size} for start, size in ((0, 36), (36, 8), (44, 24))]
        accessors = [{"bufferView": view, "componentType": 5126, "type": kind, "count": count}
                     for view, kind, count in ((0, "VEC3", 3), (1, "SCALAR", 2), (2, "VEC3", 2))]
        uri = "data:application/octet-stream;base64," + base64.b64encode(numbers).decode()
        slide = {"name": "slide", "samplers": [{"input": 1, "output": 2}],
                 "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}
        rest = {"name": "rest", "samplers": [], "channels": []}
        return self.write("a.gltf", gltf(**{"bufferViews": views, "accessors": accessors, "animations": [slide, rest],
                                            "buffers": [{"byteLength": len(numbers), "uri": uri}], **changes}))

    def picture(self, *arguments):
        self.assert_rendered(self.render("a.gltf", *arguments))
        return self.read("out.png")

    def test_pictures(self):
        self.animated()
        rest = self.picture()
        self.assertEqual(rest, self.picture("--animation", "slide"))
        self.assertEqual(rest, self.picture("--animation", "rest", "--time", "2"))
        moved = self.picture("--animation", "slide", "--time", "2", "--json", "out.json")
        self.assertNotEqual(rest, moved)
        described = json.loads(self.read("out.json"))
        self.assertEqual((described["animation"], described["time_s"]), ("slide", 2))
        for same in (["--time", "2"], ["--animation", "0", "--time", "99.5"]):
            self.assertEqual(moved, self.picture(*same))

    def test_info_of_a_scene_far_away(self):
        vertices = "".join(f"v {431000.125 + x} {5412000.5 + y} {120.25 + z}\n"
                           for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)))
        self.write("far.obj", vertices + TETRAHEDRON[TETRAHEDRON.index("f"):])
        result = self.run_cli("info", "far.obj", "--add-volume", "volume:luneburg,resolution=8@431002,5412001,121")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[2], "origin: 431000.5 5412001 121 m, subtracted from all positions")
        low = [float(number) for number in lines[1].split()[1:4]]
        self.assertEqual(low, [431000.125, 5411999.9375, 119.9375], "the lens reaches 1.0625 from its centre")
        self.assertEqual(result.stderr, "")

    def test_info(self):
        self.animated()
        result = self.run_cli("info", "a.gltf")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertIn("a.gltf: 1 object, 1 mesh, 1 triangle\n", result.stdout)
        self.assertIn("box: 0 0 0 to 1 1 0 m\n", result.stdout)
        self.assertIn("camera: front\n", result.stdout)
        self.assertIn("animation 0: slide, 2 s, deforms 0 meshes, moves 1 object\n", result.stdout)
        self.assertIn("animation 1: rest, 0 s, deforms 0 meshes, moves 0 objects\n", result.stdout)
        result = self.run_cli("info", "a.gltf", "--animation", "slide", "--time", "1")
        self.assertIn("box: 4.5 0 0 to 5.5 1 0 m\n", result.stdout)

    def test_refused(self):
        self.animated()
        for command in (["render", "-o", "out.png"], ["compare"], ["info"]):
            for words, arguments in ((["a.gltf", "'walk'", "known: slide, rest"], ["--animation", "walk"]),
                                     (["'2'", "known: slide, rest"], ["--animation", "2"]),
                                     (["time -1"], ["--time", "-1"]), (["time -1"], ["--animation", "slide", "--time", "-1"]),
                                     (["--time", "nan"], ["--time", "nan"]), (["--time", "inf"], ["--time", "inf"]),
                                     (["--time", "soon"], ["--time", "soon"])):
                with self.subTest(command=command, arguments=arguments):
                    self.assert_refused(self.run_cli(command[0], "a.gltf", *command[1:], *arguments), *words)
        bench = self.run_cli("bench", "a.gltf", "--animation", "walk")  # the head of its table stands before any scene
        self.assertEqual(bench.returncode, 2)
        self.assertRegex(bench.stderr, r"\Apellucid: a.gltf: [^\n]*'walk'; known: slide, rest\n\Z")
        self.assert_refused(self.run_cli("info", "shape:cube", "--time", "1"), "shape:cube", "no animations")
        self.assert_refused(self.run_cli("info", "--time", "1"), "scene")
        self.animated(animations=[])
        self.assert_refused(self.run_cli("info", "a.gltf", "--animation", "slide"), "a.gltf", "no animations")
        self.assertEqual(self.files(), ["a.gltf"])


class Cameras(CliTest):
    def picture(self, *arguments):
        self.assert_rendered(self.render("a.gltf", *arguments))
        return self.read("out.png")

    def test_choice(self):
        self.write("a.gltf", gltf())
        first = self.picture()
        self.assertEqual(first, self.picture("--camera", "front"))
        self.assertNotEqual(first, self.picture("--camera", "orbit:90,0,3"))
        self.refuses(["back", "known: front, orbit:AZ,EL,DIST"], "--camera", "back", scene="a.gltf")

    def test_field_of_view(self):
        self.write("a.gltf", gltf())
        orbit = self.picture("--camera", "orbit:90,0,3")
        self.assertNotEqual(orbit, self.picture("--camera", "orbit:90,0,3", "--fov", "60"))
        for camera in ([], ["--camera", "front"]):  # the file's have their own
            self.refuses("--fov", *camera, "--fov", "60", scene="a.gltf")
        # Alone it widens the camera that frames the scene: same size of the object, more perspective.
        self.assert_rendered(self.render("shape:cube"))
        framed = self.read("out.png")
        self.assert_rendered(self.render("shape:cube", "--fov", "90"))
        self.assertNotEqual(framed, self.read("out.png"))


class Environments(CliTest):
    def test_bad_files(self):
        self.refuses(["gone.hdr", "no such file"], "--environment", "gone.hdr")
        for name, content in (("empty.hdr", b""), ("text.exr", b"hello"), ("cut.hdr", b"#?RADIANCE\n")):
            self.refuses(self.write(name, content), "--environment", name)


class CollectedFiles(CliTest):
    """Whatever the collected files hold: a picture without NaN, or one line."""

    def check(self, file):
        for old in self.files():
            os.remove(self.path(old))
        # Without the validation layer, which doubles the time: what differs here comes before the device.
        result = self.run_cli("render", file, "-o", "out.exr", "--size", "32x32")
        if result.returncode == 0:
            self.assert_rendered(result, "out.exr")
            self.assertTrue(all(map(math.isfinite, read_exr(self.read("out.exr")).pixels)))
            for line in result.stderr.splitlines():
                self.assertTrue(line.startswith("pellucid: warning: "), line)
        else:
            self.assert_refused(result, os.path.basename(file))
            self.assertEqual(self.files(), [])

    def test_all(self):
        data = os.environ.get("PELLUCID_TEST_DATA", "")
        if not os.path.isdir(os.path.join(data, "bad")):
            self.skipTest("PELLUCID_TEST_DATA names no folder with bad/")
        for folder, _, names in sorted(os.walk(os.path.join(data, "bad"))):
            for name in sorted(names):
                with self.subTest(name):
                    self.check(os.path.join(folder, name))


if __name__ == "__main__":
    cli.main()
