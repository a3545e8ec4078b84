"""What moves between frames: the image is that of a fresh scene."""
import numpy as np

import pellucid
import python_test
from python_test import PythonTest, copied_from_arrays, renderer_of

TECHNIQUES = ("visibility-layers", "ray-tracing-cpu")


class Changes(PythonTest):
    def setUp(self):
        super().setUp()
        self.scene = copied_from_arrays(pellucid.load_scene("shape:torus"))
        self.camera = pellucid.framing_camera(self.scene.bounds, 32, 32)

    def image(self, renderer, technique):
        renderer.set_camera(self.camera)
        return renderer.render(32, 32, technique).radiance

    def assert_equals_fresh(self, change, fresh):
        """`change` of a renderer that has drawn the old scene against a renderer of the scene `fresh`."""
        for technique in TECHNIQUES:
            with self.subTest(technique):
                renderer = renderer_of(self.scene)
                before = self.image(renderer, technique)
                change(renderer)
                after = self.image(renderer, technique)
                self.assertFalse(np.array_equal(after, before))
                np.testing.assert_array_equal(after, self.image(renderer_of(fresh), technique))

    def with_mesh(self, vertices, normals):
        fresh = pellucid.Scene()
        fresh.add_material(self.scene.materials[0])
        fresh.add_object(fresh.add_mesh(vertices, self.scene.faces(0), normals), 0)
        return fresh

    def test_vertices(self):
        vertices = self.scene.vertices(0) * (1.0, 1.5, 0.8)
        normals = self.scene.normals(0) / np.float32((1.0, 1.5, 0.8))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        self.assert_equals_fresh(lambda r: r.set_vertices(0, vertices, normals), self.with_mesh(vertices, normals))

    def test_vertices_with_made_normals(self):
        vertices = self.scene.vertices(0) * (0.7, 1.2, 1.0)
        self.assert_equals_fresh(lambda r: r.set_vertices(0, vertices), self.with_mesh(vertices, None))

    def test_transform(self):
        transform = np.eye(4)
        transform[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        transform[:3, 3] = (0.1, 0.2, 0.0)
        fresh = copied_from_arrays(self.scene)
        fresh.set_transform(0, transform)
        self.assert_equals_fresh(lambda r: r.set_transform(0, transform), fresh)

    def test_material(self):
        material = pellucid.Material.glass(1.3, (0.9, 0.2, 0.1), 0.5)
        fresh = copied_from_arrays(self.scene)
        fresh.set_material(0, material)
        self.assert_equals_fresh(lambda r: r.set_material(0, material), fresh)

    def test_wrong_changes(self):
        renderer = renderer_of(self.scene)
        vertices = self.scene.vertices(0)
        self.refuses("there is no mesh 3; the scene has 1", lambda: renderer.set_vertices(3, vertices))
        self.refuses("vertices: must be of shape (n, 3)", lambda: renderer.set_vertices(0, vertices[:, :2]))
        for call in (lambda: renderer.set_vertices(0, vertices[:-1]),
                     lambda: renderer.set_vertices(0, vertices, self.scene.normals(0)[:-1]),
                     lambda: renderer.set_vertices(0, vertices * np.nan, self.scene.normals(0)),
                     lambda: renderer.set_transform(5, np.eye(4)),
                     lambda: renderer.set_transform(0, np.diag([1, 1, 0, 1])),
                     lambda: renderer.set_material(2, pellucid.Material()),
                     lambda: renderer.set_light(0, pellucid.Light())):
            self.refuses("", call)

    def test_scene_copies_do_not_change_the_scene(self):
        material = self.scene.materials[0]
        material.ior = 1.9
        self.assertNotAlmostEqual(self.scene.materials[0].ior, 1.9)


if __name__ == "__main__":
    python_test.main()
