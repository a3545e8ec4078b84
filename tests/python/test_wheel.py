"""The wheel: built without a network, and imported from a folder of its own."""
import os
import subprocess
import sys
import zipfile

import numpy as np

import pellucid
import python_test
from python_test import ROOT, PythonTest, renderer_of

RENDER = """
import numpy, pellucid
renderer = pellucid.Renderer()
renderer.set_scene(pellucid.load_scene("shape:goblet"))
renderer.set_environment("studio")
frame = renderer.render(24, 24)
numpy.save("frame.npy", frame.radiance)
pellucid.write_image("frame.png", frame.display)
print(pellucid.__file__)
"""


class Wheel(PythonTest):
    def test_it_renders_what_the_build_renders(self):
        built = subprocess.run([sys.executable, "-m", "build", "--no-isolation", "--wheel", "--outdir", self.folder,
                                ROOT / "python"], capture_output=True, text=True, timeout=250)
        self.assertEqual(built.returncode, 0, built.stdout[-2000:] + built.stderr[-2000:])
        (wheel,) = self.folder.glob("pellucid-*.whl")
        self.assertIn(pellucid.__version__, wheel.name)
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(self.folder / "site")
            for name in ("__init__.pyi", "py.typed"):
                self.assertIn(f"pellucid/{name}", archive.namelist())
        environment = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"}
        environment["PYTHONPATH"] = str(self.folder / "site")
        said = subprocess.run([sys.executable, "-c", RENDER], cwd=self.folder, env=environment, check=True,
                              capture_output=True, text=True, timeout=250).stdout
        self.assertIn(str(self.folder / "site"), said)
        expected = renderer_of(pellucid.load_scene("shape:goblet")).render(24, 24).radiance
        np.testing.assert_array_equal(np.load(self.folder / "frame.npy"), expected)
        self.assertTrue((self.folder / "frame.png").stat().st_size > 100)


if __name__ == "__main__":
    python_test.main()
