"""Frames: equal to those of the command line, in arrays that own their pixels."""
import gc
import threading

import numpy as np

import pellucid
import python_test
from python_test import PythonTest, renderer_of


class Frames(PythonTest):
    def test_equal_the_command_line_byte_for_byte(self):
        for technique in ("visibility-layers", "wang-2014", "path"):
            with self.subTest(technique):
                arguments = ["render", "shape:knot", "--size", "65x47", "--technique", technique, "--samples", "3"]
                self.run_cli(*arguments, "-o", "cli.png")
                self.run_cli(*arguments, "-o", "cli.exr")
                frame = renderer_of(pellucid.load_scene("shape:knot")).render(65, 47, technique, samples=3)
                pellucid.write_image(self.folder / "python.png", frame.display)
                self.assertEqual((self.folder / "python.png").read_bytes(), (self.folder / "cli.png").read_bytes())
                radiance = pellucid.read_image(self.folder / "cli.exr")
                np.testing.assert_array_equal(frame.radiance, radiance[..., :3])

    def test_every_aov_equals_the_command_line(self):
        names = list(pellucid.aovs())
        parts = [name for name in names if name in ("emitted", "direct", "caustic", "indirect")]
        for technique, aovs in (("visibility-layers", [n for n in names if n not in parts]), ("path", parts)):
            files = [word for name in aovs for word in ("--aov", f"{name}={name}.exr")]
            self.run_cli("render", "shape:goblet", "-o", "out.png", "--size", "33x31", "--technique", technique, *files)
            frame = renderer_of(pellucid.load_scene("shape:goblet")).render(33, 31, technique, aovs=aovs)
            self.assertEqual(sorted(frame.aovs), sorted(aovs))
            for name in aovs:
                with self.subTest(name):
                    channels = pellucid.aovs()[name][0]
                    self.assertEqual(frame.aovs[name].shape, (31, 33) if channels == 1 else (31, 33, channels))
                    np.testing.assert_array_equal(frame.aovs[name], pellucid.read_image(self.folder / f"{name}.exr"))

    def test_arrays_own_the_images_without_a_copy(self):
        renderer = renderer_of(pellucid.load_scene("shape:sphere"))
        frame = renderer.render(16, 16, aovs=["depth"], paths=True)
        for array in (frame.radiance, frame.display, frame.aovs["depth"], frame.paths):
            self.assertFalse(array.flags.owndata)
            self.assertEqual(type(array.base).__name__, "PyCapsule")
            self.assertTrue(array.flags.writeable and array.flags.c_contiguous)
        kept, expected = frame.radiance, frame.radiance.copy()
        del renderer, frame
        gc.collect()
        np.testing.assert_array_equal(kept, expected)

    def test_parameters_take_names_and_numbers(self):
        renderer = renderer_of(pellucid.load_scene("shape:torus"))
        named = next(p for t in pellucid.techniques() for p in t.parameters if t.name == "visibility-layers" and p.names)
        name, value = next(iter(named.names.items()))
        frames = [renderer.render(16, 16, "visibility-layers", {named.name: given}) for given in (name, value)]
        np.testing.assert_array_equal(frames[0].radiance, frames[1].radiance)
        self.refuses([named.name, "nothing"], lambda: renderer.render(8, 8, parameters={named.name: "nothing"}))

    def test_other_threads_run_while_one_renders(self):
        renderer = renderer_of(pellucid.load_scene("shape:goblet"))
        renderer.render(256, 256, "path")
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                done.wait(0.0005)

        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        renderer.render(256, 256, "path", samples=4)
        during = counted[0] - before
        done.set()
        thread.join()
        self.assertGreater(during, 10)

    def test_two_threads_may_use_one_renderer(self):
        renderer = renderer_of(pellucid.load_scene("shape:goblet"))
        expected = renderer.render(32, 32).radiance
        frames = []
        threads = [threading.Thread(target=lambda: frames.append(renderer.render(32, 32).radiance)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(frames), 4)
        for frame in frames:
            np.testing.assert_array_equal(frame, expected)

    def test_progress_is_called_and_its_exception_is_raised(self):
        renderer = renderer_of(pellucid.load_scene("shape:sphere"))
        shares = []
        renderer.render(32, 32, "path", samples=4, progress=shares.append)
        self.assertTrue(shares and all(0.0 <= share <= 1.0 for share in shares))
        with self.assertRaises(ZeroDivisionError):
            renderer.render(32, 32, "path", samples=4, progress=lambda share: 1 // 0)
        renderer.render(8, 8)

    def test_no_validation_messages(self):
        renderer = pellucid.Renderer(validation=True)
        renderer.set_scene(pellucid.load_scene("shape:goblet"))
        renderer.render(16, 16, aovs=["depth"])
        self.assertEqual(renderer.validation_messages, [])


class Measures(PythonTest):
    def test_compare_equals_the_command_line(self):
        import json
        for name, technique in (("a", "wang-2014"), ("b", "one-interface")):
            for kind in ("png", "exr"):
                self.run_cli("render", "shape:knot", "-o", f"{name}.{kind}", "--size", "48x48", "--technique", technique)
        for kind in ("png", "exr"):
            self.run_cli("difference", f"a.{kind}", f"b.{kind}", "--json", "difference.json")
            expected = json.loads((self.folder / "difference.json").read_text())
            images = [pellucid.read_image(self.folder / f"{name}.{kind}") for name in "ab"]
            found = pellucid.compare(*images, hdr=kind == "exr")
            self.assertAlmostEqual(found["flip_mean"], expected["flip_mean"], places=12)
            self.assertAlmostEqual(found["rmse"], expected["rmse"], places=12)
            self.assertEqual(found["flip"].shape, (48, 48))
            mask = np.zeros((48, 48), bool)
            mask[20:30] = True
            masked = pellucid.compare(*images, mask, hdr=kind == "exr")
            self.assertAlmostEqual(masked["flip_mean"], float(found["flip"][mask].mean(dtype=np.float64)), places=9)

    def test_paths_agree_with_the_exact_tracer(self):
        scene = pellucid.load_scene("shape:sphere")
        camera = pellucid.framing_camera(scene.bounds, 64, 64)
        renderer = renderer_of(scene)
        renderer.set_camera(camera)
        exact = pellucid.Tracer(scene).exact(camera, 64, 64)
        paths = renderer.render(64, 64, "visibility-layers", paths=True).paths
        found = pellucid.compare_paths(exact, paths, camera)
        self.assertGreater(found["covered"], 1000)
        self.assertGreater(found["within_1deg"], 0.99)
        self.assertEqual(found["error_deg"].shape, (64, 64))
        itself = pellucid.compare_paths(exact, exact, camera)
        self.assertEqual((itself["within_1deg"], itself["p95_deg"]), (1.0, 0.0))

    def test_thickness_equals_the_command_line(self):
        glow = ["shape:torus", "--size", "40x40", "--translucent", "0.8,0.3,0.2,0.1", "--add-light", "spot:0,3,0,0,0,0,60,9"]
        scene = pellucid.load_scene("shape:torus")
        material = scene.materials[0]
        material.transmission, material.diffuse_transmission = 0.0, 0.5
        material.attenuation_color, material.attenuation_distance = (0.8, 0.3, 0.2), 0.1
        scene.set_material(0, material)
        scene.add_light(pellucid.Light(kind="spot", position=(0, 3, 0), direction=(0, -1, 0), intensity=(9, 9, 9),
                                       inner_cone_angle=0.0, outer_cone_angle=np.radians(60)))
        self.run_cli("thickness", *glow, "-o", "layers.exr")
        self.run_cli("thickness", *glow, "-o", "exact.exr", "--method", "exact")
        camera = pellucid.framing_camera(scene.bounds, 40, 40)
        layers = renderer_of(scene).thickness(40, 40)
        exact = pellucid.Tracer(scene).thickness(camera, 40, 40)
        self.assertGreater(layers.max(), 0.01)
        found = pellucid.compare_thickness(exact, layers)
        self.assertLess(found["relative"], 0.05)
        self.assertEqual(found["difference"].shape, (40, 40))
        for name, image in (("layers", layers), ("exact", exact)):
            expected = pellucid.read_image(self.folder / f"{name}.exr")
            agree = np.abs(image - expected) < 1e-4
            self.assertGreater(agree.mean(), 0.97, name)


if __name__ == "__main__":
    python_test.main()
