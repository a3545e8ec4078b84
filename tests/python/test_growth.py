"""Memory does not grow from frame to frame."""
import gc

import numpy as np

import pellucid
import python_test
from python_test import PythonTest, renderer_of

WARM_UP = 20


def resident_kib():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4


def growth_kib(frames, size):
    """Growth of the resident memory over frames whose vertices and material change, after the first ones."""
    scene = pellucid.load_scene("shape:goblet")
    renderer = renderer_of(scene)
    vertices, normals, material = scene.vertices(0), scene.normals(0), scene.materials[0]
    for i in range(WARM_UP + frames):
        if i == WARM_UP:
            gc.collect()
            before = resident_kib()
        renderer.set_vertices(0, vertices * np.float32(1.0 + 0.001 * (i % 7)), normals)
        material.ior = 1.4 + 0.01 * (i % 5)
        renderer.set_material(0, material)
        renderer.render(size, size, "visibility-layers", aovs=["depth", "normal"], paths=True)
    gc.collect()
    return resident_kib() - before


class Growth(PythonTest):
    def test_over_60_frames(self):
        # Frames that were kept would be 230 KiB each, 13 MiB in all.
        self.assertLess(growth_kib(60, 48), 3000)


class LongGrowth(PythonTest):
    def test_over_1000_frames(self):
        # One array that was kept would be 768 KiB, and 750 MiB over the frames.
        self.assertLess(growth_kib(1000, 256), 8000)


if __name__ == "__main__":
    python_test.main()
