"""Runs inside Blender with a window: shows a ball of glass in a viewport drawn by Pellucid, saves a screenshot and quits.

    blender --factory-startup --python viewport_in_blender.py -- SCREENSHOT.png
"""
import os
import sys
from pathlib import Path

import bpy

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "python/blender"), str(HERE), *os.environ.get("PYTHONPATH", "").split(":")]
import pellucid_engine  # noqa: E402

SAMPLES = 4


def show():
    pellucid_engine.register()
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=1.5)
    glass = bpy.data.materials.new("glass")
    glass.use_nodes = True
    nodes = glass.node_tree.nodes
    nodes.clear()
    surface, output = nodes.new("ShaderNodeBsdfGlass"), nodes.new("ShaderNodeOutputMaterial")
    glass.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(glass)
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.9, 0.01, 0.01, 1)
    bpy.context.scene.render.engine = "PELLUCID"
    bpy.context.scene.pellucid.viewport_samples = SAMPLES
    window = bpy.context.window_manager.windows[0]
    for area in window.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.shading.type = "RENDERED"
            area.spaces.active.overlay.show_overlays = False
    bpy.app.timers.register(wait, first_interval=2.0)


waited = 0


def wait():
    """Until all samples are drawn; a redraw is asked for at every step."""
    global waited
    from pellucid_engine.engine import View

    waited += 1
    finished = any(view.samples >= SAMPLES for view in View.shown)
    if not finished and waited < 200:
        for area in bpy.context.window_manager.windows[0].screen.areas:
            area.tag_redraw()
        return 0.5
    if finished:
        window = bpy.context.window_manager.windows[0]
        with bpy.context.temp_override(window=window):
            bpy.ops.screen.screenshot(filepath=sys.argv[-1])
    os._exit(0 if finished else 1)


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(show, first_interval=0.5)
