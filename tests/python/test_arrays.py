"""Scenes from arrays: the same as from files; wrong arrays are refused in one line."""
import numpy as np

import pellucid
import python_test
from python_test import PythonTest, copied_from_arrays, renderer_of

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])


class ScenesFromArrays(PythonTest):
    def test_files_outside_the_scenes_folder_need_permission(self):
        (self.folder / "scene").mkdir()
        (self.folder / "m.mtl").write_text("newmtl m\nKd 1 0 0\n")
        scene = self.folder / "scene" / "a.obj"
        scene.write_text("mtllib ../m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n")
        self.refuses(["m.mtl", "outside"], lambda: pellucid.load_scene(str(scene)))
        self.assertEqual(pellucid.load_scene(str(scene), allow_outside=True).materials[0].name, "m")

    def test_the_arrays_of_a_file_give_its_image(self):
        scene = pellucid.load_scene("shape:knot")
        expected = renderer_of(scene).render(32, 32).radiance
        found = renderer_of(copied_from_arrays(scene)).render(32, 32).radiance
        np.testing.assert_array_equal(found, expected)

    def test_every_real_type_and_order_is_taken(self):
        scene = pellucid.load_scene("shape:cube")
        vertices, faces = scene.vertices(0), scene.faces(0)
        for given in (vertices.astype(float), np.asfortranarray(vertices), vertices[::-1][::-1], vertices.tolist()):
            for indices in (faces, faces.astype(np.int64), faces.astype(np.uint8), faces.tolist()):
                copy = pellucid.Scene()
                mesh = copy.add_mesh(given, indices, scene.normals(0))
                np.testing.assert_array_equal(copy.vertices(mesh), vertices)
                np.testing.assert_array_equal(copy.faces(mesh), faces)

    def test_made_normals(self):
        sphere = pellucid.load_scene("shape:sphere")
        scene = pellucid.Scene()
        mesh = scene.add_mesh(sphere.vertices(0), sphere.faces(0))
        self.assertGreater(np.sum(scene.normals(mesh) * sphere.normals(0), axis=1).min(), 0.99)
        box = pellucid.load_scene("shape:cube")
        corners, inverse = np.unique(box.vertices(0), axis=0, return_inverse=True)
        faces = inverse[box.faces(0).astype(int)]
        smooth, sharp = scene.add_mesh(corners, faces), scene.add_mesh(corners, faces, crease_angle=0.5)
        self.assertEqual(len(scene.vertices(smooth)), 8)
        self.assertEqual(len(scene.vertices(sharp)), 24)

    def test_textures(self):
        image = np.zeros((2, 2, 3), np.float32)
        image[..., 1] = 1.0
        scene = pellucid.Scene()
        texture = pellucid.Texture(image=scene.add_image(image, "green"), wrap_u="clamp")
        self.assertEqual(texture.wrap_u, "clamp")
        material = scene.add_material(pellucid.Material(base_color_texture=texture, unlit=True))
        mesh = scene.add_mesh(SQUARE - [0.5, 0.5, 0], TRIANGLES, texcoords=SQUARE[:, :2])
        scene.add_object(mesh, material)
        renderer = renderer_of(scene, "uniform")
        renderer.set_camera(pellucid.Camera.look_at((0, 0, 3), (0, 0, 0)))
        middle = renderer.render(9, 9).radiance[4, 4]
        np.testing.assert_allclose(middle, (0, 1, 0), atol=1e-3)

    def test_environment_from_an_array(self):
        sky = np.ones((4, 8, 3)) * (0.25, 0.5, 1.0)
        renderer = pellucid.Renderer()
        renderer.set_environment(pellucid.Environment(sky, intensity=2.0))
        np.testing.assert_allclose(renderer.render(4, 4).radiance, np.broadcast_to((0.5, 1.0, 2.0), (4, 4, 3)), rtol=1e-3)
        renderer.set_environment(sky)
        np.testing.assert_allclose(renderer.render(4, 4).radiance[0, 0], (0.25, 0.5, 1.0), rtol=1e-3)

    def test_lights(self):
        scene = pellucid.Scene()
        material = scene.add_material(pellucid.Material(base_color=(1, 1, 1, 1), roughness=1.0))
        scene.add_object(scene.add_mesh(SQUARE - [0.5, 0.5, 0], TRIANGLES), material)
        scene.add_light(pellucid.Light(kind="directional", direction=(0, 0, -1), intensity=(np.pi, 0, 0)))
        renderer = renderer_of(scene, pellucid.Environment("uniform", intensity=0.0))
        renderer.set_camera(pellucid.Camera.look_at((0, 0, 3), (0, 0, 0)))
        red, green, _ = renderer.render(9, 9).radiance[4, 4]
        self.assertAlmostEqual(red, 1.0, delta=0.1)
        self.assertEqual(green, 0.0)

    def test_volumes(self):
        made = pellucid.make_volume("luneburg")
        self.assertEqual(made.n.ndim, 3)
        fields = {name: getattr(made, name) for name in ("n", "n_red", "n_blue", "sigma_a", "sigma_s", "g", "emission",
                                                         "boundary") if getattr(made, name) is not None}
        copy = pellucid.Volume(made.voxel, low=made.low, **fields)
        images = []
        for volume in (made, copy):
            scene = pellucid.Scene()
            scene.add_volume(volume)
            images.append(renderer_of(scene).render(24, 24, "ihrke-2007").radiance)
        np.testing.assert_array_equal(images[0], images[1])
        empty = renderer_of(pellucid.load_scene("volume:luneburg")).render(24, 24, "ihrke-2007").radiance
        np.testing.assert_array_equal(images[0], empty)
        pellucid.save_volume(self.folder / "luneburg.vdb", copy)
        np.testing.assert_allclose(pellucid.load_volume(self.folder / "luneburg.vdb").n, made.n, atol=1e-6)

    def test_cameras(self):
        camera = pellucid.Camera.look_at((0, 0, 5), (0, 0, 0), vertical_fov=np.radians(60))
        np.testing.assert_allclose(camera.world_from_view[:3, 3], (0, 0, 5))
        matrix = camera.intrinsics(640, 480)
        self.assertAlmostEqual(matrix[0, 0], 240 / np.tan(np.radians(30)), places=3)
        np.testing.assert_allclose(matrix[:2, 2], (320, 240))
        self.refuses("line", lambda: pellucid.Camera.look_at((0, 5, 0), (0, 0, 0)))


class WrongArrays(PythonTest):
    def test_meshes(self):
        scene = pellucid.Scene()
        for words, arguments in (
            ("vertices: must be of shape (n, 3), not (4, 2)", (SQUARE[:, :2], TRIANGLES)),
            ("vertices: must be an array of numbers", (SQUARE.astype(str), TRIANGLES)),
            ("vertices: must be an array of numbers", (SQUARE.astype(complex), TRIANGLES)),
            ("vertices: must be an array of numbers", ([[1, 2, 3], [1]], TRIANGLES)),
            ("a position is not finite", (np.full((4, 3), np.nan), TRIANGLES)),
            ("faces: must be integers of shape (n, 3), not float64 (2, 3)", (SQUARE, TRIANGLES.astype(float))),
            ("faces: must be integers of shape (n, 3), not int64 (1, 4)", (SQUARE, [[0, 1, 2, 3]])),
            ("faces: row 1 refers to vertex -1", (SQUARE, [[0, 1, 2], [0, 2, -1]])),
            ("refers to a vertex that is not there", (SQUARE, [[0, 1, 4]])),
            ("normals: must be of shape (n, 3)", (SQUARE, TRIANGLES, [1, 2, 3])),
            ("one finite normal per position", (SQUARE, TRIANGLES, SQUARE[:3])),
            ("texcoords: must be of shape (n, 2)", (SQUARE, TRIANGLES, None, SQUARE)),
            ("colors: must be of shape (n, 4)", (SQUARE, TRIANGLES, None, None, SQUARE)),
        ):
            with self.subTest(words):
                self.refuses(words, lambda: scene.add_mesh(*arguments))
        self.assertEqual(scene.mesh_count, 0)

    def test_the_rest(self):
        scene = pellucid.Scene()
        material, mesh = scene.add_material(pellucid.Material()), scene.add_mesh(SQUARE, TRIANGLES)
        last_row = np.eye(4)
        last_row[3, 0] = 1
        for words, call in (
            ("transform: must be of shape (4, 4), not (3, 3)", lambda: scene.add_object(mesh, material, np.eye(3))),
            ("transform: the last row", lambda: scene.add_object(mesh, material, last_row)),
            ("there is no mesh 7; the scene has 1", lambda: scene.add_object(7, material)),
            ("there is no material -1", lambda: scene.add_object(mesh, -1)),
            ("base_color: must be 4 numbers", lambda: pellucid.Material(base_color=(1, 1, 1))),
            ("unknown property 'iorr' (did you mean ior?)", lambda: pellucid.Material(iorr=1.5)),
            ("unknown kind of light", lambda: pellucid.Light(kind="sun")),
            ("environment: must be of shape (height, width, 3)", lambda: pellucid.Environment(np.ones((4, 4)))),
            ("n: must be of shape (z, y, x)", lambda: pellucid.Volume(0.1, n=np.ones((4, 4)))),
            ("voxels along x, y and z", lambda: pellucid.Volume(0.1, n=np.ones((4, 4, 4)), g=np.ones((4, 4, 5)))),
            ("unknown field of a volume 'm'", lambda: pellucid.Volume(0.1, m=np.ones((4, 4, 4)))),
            ("reference: must be of shape (height, width, 3)", lambda: pellucid.flip(np.ones((4, 4)), np.ones((4, 4, 3)))),
            ("exact: must be an array of paths", lambda: pellucid.compare_paths(np.ones((4, 4)), np.ones((4, 4)), pellucid.Camera())),
            ("nowhere.glb", lambda: pellucid.load_scene("nowhere.glb")),
            ("unknown technique", lambda: pellucid.Renderer().render(8, 8, "wang-204")),
            ("unknown AOV", lambda: pellucid.Renderer().render(8, 8, aovs=["dept"])),
        ):
            with self.subTest(words):
                self.refuses(words, call)

    def test_a_missing_device(self):
        with self.assertRaises((pellucid.Error, pellucid.DeviceError)):
            pellucid.Renderer(device="no such device")


if __name__ == "__main__":
    python_test.main()
