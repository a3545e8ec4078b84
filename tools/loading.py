"""Loads what scripts of this folder share: scripts themselves, and pixels of images."""
import importlib.machinery
import importlib.util
import sys
from pathlib import Path

TOOLS = Path(__file__).resolve().parent
sys.path.insert(0, str(TOOLS.parent / "tests/cli"))
from pictures import read_exr  # noqa: E402


def load_tool(name):
    """The script `name` of this folder as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def rgb_of(picture):
    """Red, green and blue of every pixel of an EXR file, one after the other; other channels are left out."""
    image = read_exr(Path(picture).read_bytes())
    wanted, count = [image.channels.index(name) for name in "RGB"], len(image.channels)
    return [image.pixels[first + i] for first in range(0, len(image.pixels), count) for i in wanted]
