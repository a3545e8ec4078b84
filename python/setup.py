"""Wheel of the package: `python3 -m build --no-isolation --wheel python`, without a network.

CMake builds the module and the library into build/wheel; PELLUCID_BUILD names a folder that it has built already.
"""
import os
import re
import subprocess
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "wheel"


def version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(pellucid VERSION ([\d.]+)", text).group(1)


def built_folder():
    if "PELLUCID_BUILD" in os.environ:
        return Path(os.environ["PELLUCID_BUILD"])
    folder = WORK / "cmake"
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    "-DPELLUCID_BUILD_TESTS=OFF", "-DPELLUCID_BUILD_PYTHON=ON"], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "pellucid_python", "pellucid_images", "pellucid_reader"], check=True)
    return folder


class BuildWithCMake(build_py):
    """The package, with the library beside the module."""

    def run(self):
        super().run()
        build, staged = built_folder(), (WORK / "staged").resolve()
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", staged], check=True)
        target = Path(self.build_lib).resolve() / "pellucid"
        for module in staged.glob("**/_pellucid*.so"):
            self.copy_file(str(module), str(target / module.name))
        interface = ".".join(version().split(".")[:2])  # as SOVERSION in src/CMakeLists.txt
        for name in (f"libpellucid.so.{interface}", "libpellucid_images.so", "pellucid-reader"):
            self.copy_file(str(build / "lib" / name), str(target / name))


class BinaryDistribution(Distribution):
    def has_ext_modules(self):
        return True


WORK.mkdir(parents=True, exist_ok=True)
setup(version=version(), cmdclass={"build_py": BuildWithCMake}, distclass=BinaryDistribution,
      package_data={"pellucid": ["*.pyi", "py.typed"]},
      options={"build": {"build_base": str(WORK / "base")}, "egg_info": {"egg_base": str(WORK)}})
