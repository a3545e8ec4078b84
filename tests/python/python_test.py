"""What the tests of the Python package share. The program of $PELLUCID_BINARY is what they are compared with."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import pellucid

SKIPPED = 77  # exit code for "nothing could be tested", as tests/python/CMakeLists.txt tells ctest
ROOT = Path(__file__).resolve().parents[2]


class PythonTest(unittest.TestCase):
    """Each test has a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="pellucid-python-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_cli(self, *arguments):
        result = subprocess.run([os.environ["PELLUCID_BINARY"], *map(str, arguments)], cwd=self.folder,
                                capture_output=True, text=True, timeout=250)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def refuses(self, words, call):
        """pellucid.Error in one line that has all of `words`."""
        with self.assertRaises(pellucid.Error) as caught:
            call()
        message = str(caught.exception)
        self.assertNotIn("\n", message)
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, message)


def renderer_of(scene, environment="studio"):
    renderer = pellucid.Renderer()
    renderer.set_scene(scene)
    renderer.set_environment(environment)
    return renderer


def copied_from_arrays(scene):
    """A scene of the same meshes, materials and placements, made from arrays."""
    copy = pellucid.Scene()
    for material in scene.materials:
        copy.add_material(material)
    for mesh in range(scene.mesh_count):
        copy.add_mesh(scene.vertices(mesh), scene.faces(mesh), scene.normals(mesh))
    for each in scene.objects:
        copy.add_object(each.mesh, each.material, each.transform, each.name)
    for light in scene.lights:
        copy.add_light(light)
    return copy


def main():
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    sys.exit(SKIPPED if result.testsRun and len(result.skipped) == result.testsRun else 0)
