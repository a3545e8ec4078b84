"""Data sets: deterministic, complete, and read by the loader."""
import json
import os
import struct
import subprocess

import numpy as np

import pellucid
import python_test
from pellucid import datasets
from python_test import PythonTest

IMAGES = 3
RECIPE = {"width": 48, "height": 40, "images": IMAGES, "seed": 5, "objects": {"sources": ["shape:sphere", "shape:goblet"]},
          "render": {"samples": 2}}


class DatasetTest(PythonTest):
    def make(self, name, *arguments, recipe=RECIPE):
        (self.folder / "recipe.json").write_text(json.dumps(recipe), encoding="utf-8")
        self.run_cli("dataset", "recipe.json", "--folder", name, "--quiet", *arguments)
        return self.folder / name

    def refused(self, *words, recipe=None, arguments=()):
        if recipe is not None:
            text = recipe if isinstance(recipe, str) else json.dumps(recipe)
            (self.folder / "wrong.json").write_text(text, encoding="utf-8")
        result = subprocess.run([os.environ["PELLUCID_BINARY"], "dataset", "wrong.json", "--folder", "out", *arguments],
                                cwd=self.folder, capture_output=True, text=True, timeout=250)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertRegex(result.stderr, r"\Apellucid: [^\n]+\n\Z")
        for word in words:
            self.assertIn(word, result.stderr)


class DatasetFiles(DatasetTest):
    def test_files_are_the_same_and_each_can_be_made_alone(self):
        whole = self.make("whole")
        alone = self.make("alone", "--images", "2")
        self.assertEqual(sorted(file.name for file in alone.iterdir()),
                         ["000002.background.png", "000002.exr", "000002.json", "000002.mask.png", "000002.png",
                          "annotations.2-2.json"])
        for file in alone.glob("000002.*"):
            self.assertEqual(file.read_bytes(), (whole / file.name).read_bytes(), file.name)
        self.make("alone", "--images", "0..1")
        self.make("alone", "--gather")
        self.assertEqual((alone / "annotations.json").read_bytes(), (whole / "annotations.json").read_bytes())
        self.check_content(whole)
        self.check_coco(whole)
        self.check_layouts(whole)

    def check_content(self, folder):
        dataset = datasets.Dataset(folder)
        self.assertEqual(len(dataset), IMAGES)
        colors = set()
        for sample in dataset:
            colors.add(sample["color"].tobytes())
            for name, value in sample.items():
                if isinstance(value, np.ndarray):
                    self.assertEqual(value.shape[:2], (40, 48), name)
                    self.assertTrue(np.isfinite(value).all(), name)
            glass = sample["events"] > 0
            self.assertTrue(glass.any())
            np.testing.assert_array_equal(glass, sample["instance"] > 0)
            np.testing.assert_array_equal(sample["color"][~glass].shape, sample["background"][~glass].shape)
            self.assertTrue((sample["flow"][~glass] == 0).all())
            for which in ("first", "last"):
                depth, normal = sample[f"depth_{which}"], sample[f"normal_{which}"]
                np.testing.assert_array_equal(depth > 0, glass)
                np.testing.assert_allclose(np.linalg.norm(normal[glass], axis=1), 1.0, atol=1e-3)
            self.assertTrue((sample["depth_first"][glass] < sample["depth_background"][glass]).all())
            self.assertGreater((sample["normal_first"][glass][:, 2] > 0).mean(), 0.9)  # they face the viewer
            self.assertTrue(((sample["fresnel"] >= 0) & (sample["fresnel"] <= 1)).all())
            self.check_objects(sample)
        self.assertEqual(len(colors), IMAGES)

    def check_objects(self, sample):
        """Boxes and poses against the pixels."""
        camera = np.array(sample["camera"]["K"])
        for each in sample["objects"]:
            seen = sample["instance"] == each["id"]
            np.testing.assert_array_equal(seen, datasets.mask_of(each["segmentation"]))
            whole = datasets.mask_of(each["whole_segmentation"])
            self.assertTrue((whole | ~seen).all())
            self.assertEqual((each["visible_pixels"], each["whole_pixels"]), (seen.sum(), whole.sum()))
            if not whole.any():
                continue
            signs = np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, 8)
            corners = np.array(each["rotation"]) @ (signs.T * each["half_size_m"]).T
            points = camera @ (corners + np.array(each["translation_m"])[:, None])
            points = points[:2] / points[2]
            rows, columns = np.nonzero(whole)
            self.assertGreaterEqual(columns.min() + 1, points[0].min())
            self.assertLessEqual(columns.max(), points[0].max())
            self.assertGreaterEqual(rows.min() + 1, points[1].min())
            self.assertLessEqual(rows.max(), points[1].max())

    def check_coco(self, folder):
        coco = json.loads((folder / "annotations.json").read_text(encoding="utf-8"))
        self.assertEqual([each["file_name"] for each in coco["images"]], [f"{i:06}.png" for i in range(IMAGES)])
        names = {each["id"]: each["name"] for each in coco["categories"]}
        samples = {each["image"]: each for each in datasets.Dataset(folder)}
        for each in coco["annotations"]:
            mask = datasets.mask_of(each["segmentation"])
            self.assertEqual(mask.sum(), each["area"])
            self.assertIn(names[each["category_id"]], RECIPE["objects"]["sources"])
            self.assertTrue((samples[each["image_id"]]["instance"][mask] > 0).all())
            self.assertGreater(each["area"], 0)
            rows, columns = np.nonzero(mask)
            self.assertEqual(each["bbox"], [columns.min(), rows.min(), np.ptp(columns) + 1, np.ptp(rows) + 1])

    def check_layouts(self, folder):
        dataset = datasets.Dataset(folder)
        sample = dataset[1]
        datasets.write_tom_net(dataset, self.folder / "tom")
        flow = (self.folder / "tom" / "000001_flow.flo").read_bytes()
        self.assertEqual(struct.unpack_from("<fii", flow), (202021.25, 48, 40))
        np.testing.assert_array_equal(np.frombuffer(flow[12:], "<f4").reshape(40, 48, 2), sample["flow"])
        mask = pellucid.read_image(self.folder / "tom" / "000001_mask.png")
        np.testing.assert_array_equal(mask > 0.5, sample["instance"] > 0)
        datasets.write_clear_grasp(dataset, self.folder / "clear")
        normals = pellucid.read_image(self.folder / "clear" / "camera-normals" / "000000001-cameraNormals.exr")
        np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1.0, atol=1e-3)
        depth = pellucid.read_image(self.folder / "clear" / "depth-imgs-rectified" / "000000001-depth-rectified.exr")
        self.assertTrue((depth > 0).all())
        datasets.write_bop(dataset, self.folder / "bop")
        truth = json.loads((self.folder / "bop" / "scene_gt.json").read_text())
        self.assertEqual(len(truth["1"]), len(sample["objects"]))
        np.testing.assert_allclose(np.linalg.det(np.reshape(truth["1"][0]["cam_R_m2c"], (3, 3))), 1.0, atol=1e-5)
        stored = pellucid.read_image(self.folder / "bop" / "depth" / "000001.png") * 65535 * 1e-4
        np.testing.assert_allclose(stored, depth, atol=6e-5)

    def test_the_loader_reads_what_the_library_reads(self):
        rng = np.random.default_rng(1)
        for shape in ((1, 1, 3), (40, 33, 3), (16, 64, 3)):
            for image in (rng.normal(size=shape).astype(np.float32), np.zeros(shape, np.float32)):
                pellucid.write_image(self.folder / "image.exr", image)
                channels = datasets.read_channels(self.folder / "image.exr")
                np.testing.assert_array_equal(np.stack([channels[c] for c in "RGB"], axis=-1), image)


class DatasetInput(DatasetTest):
    def test_wrong_recipes(self):
        for words, recipe in (
            (("wrong.json", "unknown key 'objects.iorr' (did you mean objects.ior?)"), {"objects": {"iorr": 1}}),
            (("wrong.json: objects.ior", "from 1 to 4", "[low, high]"), {"objects": {"ior": 0.5}}),
            (("lower end",), {"objects": {"ior": [2, 1.5]}}),
            (("objects.count", "whole number"), {"objects": {"count": [1, 2.5]}}),
            (("objects.sources", "list"), {"objects": {"sources": []}}),
            (("objects.sources", "list"), {"objects": {"sources": "shape:sphere"}}),
            (("nowhere.glb",), {"objects": {"sources": ["nowhere.glb"]}}),
            (("volume:luneburg", "refracting glass"), {"objects": {"sources": ["volume:luneburg"]}}),
            (("nowhere.png",), {"background": {"images": ["nowhere.png"]}}),
            (("unknown technique",), {"render": {"technique": "wang-204"}}),
            (("wrong.json", "JSON object"), [1]),
            (("wrong.json",), "{"),
        ):
            with self.subTest(words):
                self.refused(*words, recipe=recipe)
        for images in ("5..6", "2..1", "-1", "a..b", "1.5"):
            self.refused("--images", recipe={"images": 4}, arguments=("--images", images))

    def test_the_schema_has_every_default(self):
        schema = json.loads(self.run_cli("dataset", "--schema").stdout)

        def defaults(part):
            if part.get("type") == "object":
                return {name: defaults(inner) for name, inner in part["properties"].items()}
            return part["default"]

        (self.folder / "defaults.json").write_text(json.dumps(defaults(schema) | {"images": 1}), encoding="utf-8")
        self.run_cli("dataset", "defaults.json", "--folder", "out", "--gather", "--quiet")


if __name__ == "__main__":
    python_test.main()
