"""Pellucid as a render engine of Blender 3.4: final renders and the viewport.

The package `pellucid` must be one that Blender's Python can import: Debian's Blender uses /usr/bin/python3.
"""
import bpy

from . import engine, settings

bl_info = {
    "name": "Pellucid",
    "description": "Glass as light crosses it: refraction, total reflection, absorption and caustics",
    "blender": (3, 4, 0),
    "version": (0, 1, 0),
    "category": "Render",
}


NODE_PANELS = {"EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_MATERIAL_PT_volume",
               "EEVEE_WORLD_PT_surface", "DATA_PT_EEVEE_light"}


def panels():
    """Panels of Blender that every engine has, and those that show nodes and lamps."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", None)
        if engines is not None and ("BLENDER_RENDER" in engines or panel.__name__ in NODE_PANELS):
            yield panel


def register():
    settings.register()
    bpy.utils.register_class(engine.PellucidEngine)
    for panel in panels():
        panel.COMPAT_ENGINES.add(engine.PellucidEngine.bl_idname)


def unregister():
    for panel in panels():
        panel.COMPAT_ENGINES.discard(engine.PellucidEngine.bl_idname)
    bpy.utils.unregister_class(engine.PellucidEngine)
    settings.unregister()
