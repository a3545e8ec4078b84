"""Pellucid: transparent objects in real time, on any Vulkan 1.3 device.

Lengths are in metres, angles in radians, colours linear Rec.709. Images are float32 arrays of shape (height, width,
channels), rows from the top. Transforms are arrays of shape (4, 4) that multiply columns: world_from_object @ p.
"""
from ._pellucid import *
from ._pellucid import __version__
