#!/usr/bin/env python3
"""Measures what a frame of 512x512 costs more in Python than in C++. Needs an otherwise idle machine.

    PYTHONPATH=build/release/python python3 tests/python/measure_frame_cost.py build/release/bin/frame_cost

Both render in turn, in processes of their own; each number is the least of the rounds' medians.
"""
import subprocess
import sys
import time

ROUNDS, FRAMES, SCENE, TECHNIQUE = 5, 15, "shape:goblet", "visibility-layers"


def python_ms():
    import statistics

    import pellucid
    renderer = pellucid.Renderer()
    renderer.set_scene(pellucid.load_scene(SCENE))
    renderer.set_environment("studio")
    times = []
    for _ in range(FRAMES + 2):
        start = time.perf_counter()
        frame = renderer.render(512, 512, TECHNIQUE)
        times.append(1000 * (time.perf_counter() - start))
        assert frame.display.shape == (512, 512, 3)
    return statistics.median(times[2:])


def main():
    if sys.argv[1:] == ["--python"]:
        print(python_ms())
        return
    commands = {"C++": [sys.argv[1], SCENE, TECHNIQUE, str(FRAMES)], "Python": [sys.executable, __file__, "--python"]}
    times = {name: [] for name in commands}
    for _ in range(ROUNDS):
        for name, command in commands.items():
            times[name].append(float(subprocess.run(command, check=True, capture_output=True, text=True).stdout))
    best = {name: min(each) for name, each in times.items()}
    print(f"C++ {best['C++']:.2f} ms, Python {best['Python']:.2f} ms: {100 * (best['Python'] / best['C++'] - 1):+.2f}%")


if __name__ == "__main__":
    main()
