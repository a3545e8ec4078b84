"""The add-on for Blender: final renders beside Cycles, errors, and the viewport in a window of an X server."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import pellucid

HERE = Path(__file__).resolve().parent
SKIPPED = 77  # exit code for "nothing could be tested", as CMakeLists.txt tells ctest

def blender(*arguments, window=False):
    command = ["blender", *([] if window else ["--background"]), "--factory-startup", "--python-exit-code", "1", "--python"]
    if window:
        command = ["xvfb-run", "-a", "-s", "-screen 0 1024x768x24", *command]
    return subprocess.run([*command, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=1500)


@unittest.skipUnless(shutil.which("blender"), "there is no blender")
class BlenderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid-blender-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def measured(self, *arguments):
        result = blender(HERE / "scenes_in_blender.py", "--", *arguments, "--keep", self.folder)
        self.assertEqual(result.returncode, 0, result.stdout[-3000:])
        return {row["scene"]: row for row in (json.loads(line.removeprefix("measured ")) for line in result.stdout.splitlines()
                                              if line.startswith("measured "))}


class FinalRenders(BlenderTest):
    def test_ball(self):
        """Means agree but for noise and what Cycles makes of caustics."""
        row = self.measured("ball", "--size", "32", "--samples", "16")["ball"]
        for technique in ("path", "exact"):
            self.assertAlmostEqual(row[f"{technique}_mean"], 1.0, delta=0.03)
            self.assertLess(row[technique], row["noise"] + 0.06)


class FinalRendersOfAll(BlenderTest):
    def test_scenes(self):
        for name, row in self.measured("--size", "48", "--samples", "32").items():
            with self.subTest(name):
                self.assertAlmostEqual(row["path_mean"], 1.0, delta=0.03)
                self.assertAlmostEqual(row["exact_mean"], 1.0, delta=0.05)
                self.assertLess(row["path"], row["noise"] + 0.06)


class Viewport(BlenderTest):
    @unittest.skipUnless(shutil.which("xvfb-run"), "there is no xvfb-run")
    def test_viewport(self):
        picture = self.folder / "window.png"
        result = blender(HERE / "viewport_in_blender.py", "--", picture, window=True)
        self.assertEqual(result.returncode, 0, result.stdout[-3000:])
        image = pellucid.read_image(picture)
        red = (image[..., 0] > 0.4) & (image[..., 0] > 3 * image[..., 1:3].max(axis=2))
        self.assertGreater(red.mean(), 0.2, "the world is red")


if __name__ == "__main__":
    program = unittest.main(exit=False, verbosity=2)
    if not program.result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if program.result.testsRun and len(program.result.skipped) == program.result.testsRun else 0)
