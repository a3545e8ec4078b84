"""The examples of examples/python, as a user runs them."""
import json
import os
import re
import subprocess
import sys

import pellucid
import python_test
from python_test import ROOT, PythonTest

PAGES = [ROOT / "docs" / "python.md", ROOT / "docs" / "datasets.md"]


class ExampleTest(PythonTest):
    def run_example(self, name, *arguments):
        result = subprocess.run([sys.executable, ROOT / "examples" / "python" / name, *arguments], cwd=self.folder,
                                capture_output=True, text=True, timeout=250)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout


class Pages(PythonTest):
    """Each block of Python in the pages runs as it is written."""

    def test_blocks_of_python(self):
        small = {"width": 16, "height": 16, "images": 2, "objects": {"sources": ["shape:sphere"]}}
        (self.folder / "recipe.json").write_text(json.dumps(small), encoding="utf-8")
        self.run_cli("dataset", "recipe.json", "--folder", "out/glass", "--quiet")
        for page in PAGES:
            blocks = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
            self.assertTrue(blocks, page.name)
            for number, block in enumerate(blocks):
                with self.subTest(page=page.name, block=number):
                    result = subprocess.run([sys.executable, "-c", block], cwd=self.folder, capture_output=True,
                                            text=True, timeout=250)
                    self.assertEqual(result.returncode, 0, result.stderr)

    def test_the_recipe_is_one(self):
        page = (ROOT / "docs" / "datasets.md").read_text(encoding="utf-8")
        (recipe,) = re.findall(r"^```json\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
        (self.folder / "recipe.json").write_text(recipe, encoding="utf-8")
        self.run_cli("dataset", "recipe.json", "--folder", "out", "--gather", "--quiet")


class Examples(ExampleTest):
    def test_turntable(self):
        self.assertEqual(self.run_example("turntable.py", "shape:torus", "--frames", "3", "--size", "48x32"),
                         "3 frames in turntable\n")
        images = [pellucid.read_image(self.folder / "turntable" / f"{i:03}.png") for i in range(3)]
        self.assertEqual(images[0].shape, (32, 48, 3))
        self.assertFalse((images[0] == images[1]).all())

    def test_error_map(self):
        said = self.run_example("error_map.py", "shape:sphere", "--size", "48", "--out", "map.png")
        self.assertRegex(said, r"\Awang-2014: \d+\.\d+% of \d+ pixels within 1 degree\n\Z")
        self.assertGreater(pellucid.read_image(self.folder / "map.png").std(), 0.05)

    def test_small_dataset(self):
        said = self.run_example("small_dataset.py", "--images", "1", "--size", "32", "--out", "set", "--pellucid",
                                os.environ["PELLUCID_BINARY"])
        self.assertEqual(said, "1 images in set\n")
        self.assertGreater(pellucid.read_image(self.folder / "set" / "overview.png").std(), 0.05)


if __name__ == "__main__":
    python_test.main()
