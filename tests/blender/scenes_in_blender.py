"""Runs inside Blender: draws scenes that it makes by Pellucid and by Cycles, and prints what differs as JSON.

    blender --background --factory-startup --python scenes_in_blender.py -- NAME... [--size N] [--samples N] [--keep DIR]
"""
import argparse
import json
import math
import os
import sys
import tempfile
from pathlib import Path

import bpy
import mathutils
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "python/blender"), *os.environ.get("PYTHONPATH", "").split(":")]
import pellucid  # noqa: E402
import pellucid_engine  # noqa: E402


def node_material(name, kind, **inputs):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    surface = nodes.new("ShaderNode" + kind)
    for key, value in inputs.items():
        surface.inputs[key.replace("_", " ")].default_value = value
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(surface.outputs[0], output.inputs["Surface"])
    return material


def absorbing(material, color, density):
    tree = material.node_tree
    volume = tree.nodes.new("ShaderNodeVolumeAbsorption")
    volume.inputs["Color"].default_value = (*color, 1)
    volume.inputs["Density"].default_value = density
    tree.links.new(volume.outputs[0], tree.nodes["Material Output"].inputs["Volume"])
    return material


def place(material):
    """The object that was just added gets a material, and smooth normals."""
    thing = bpy.context.object
    for polygon in thing.data.polygons:
        polygon.use_smooth = True
    thing.data.materials.append(material)
    return thing


def empty_scene(world=(0.3, 0.4, 0.6)):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*world, 1)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (0.0, -6.0, 3.0)
    camera.rotation_euler = (mathutils.Vector((0, 0, 0.6)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 60
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.ops.mesh.primitive_plane_add(size=12)
    place(node_material("floor", "BsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    return scene


def sun(strength=3.0, angle=0.05):
    bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.3, 0.0))
    bpy.context.object.data.energy, bpy.context.object.data.angle = strength, angle


def ball(scene):
    """A ball of absorbing glass in the sun."""
    sun()
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, location=(0, 0, 1.01))
    place(absorbing(node_material("glass", "BsdfGlass", IOR=1.5, Roughness=0.0), (0.9, 0.4, 0.2), 0.8))


def principled(scene):
    """Plastic, metal and Principled glass under a lamp; three ways of making glass meet in one picture."""
    bpy.ops.object.light_add(type="POINT", location=(2, -2, 4))
    bpy.context.object.data.energy, bpy.context.object.data.shadow_soft_size = 600, 0.3
    parts = [{"Base_Color": (0.8, 0.1, 0.1, 1), "Roughness": 0.4}, {"Base_Color": (0.9, 0.7, 0.3, 1), "Metallic": 1.0, "Roughness": 0.3},
             {"Base_Color": (0.9, 1.0, 0.9, 1), "Transmission": 1.0, "Roughness": 0.0, "IOR": 1.45}]
    for i, inputs in enumerate(parts):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.7, location=(1.6 * (i - 1), 0, 0.71))
        place(node_material(f"part {i}", "BsdfPrincipled", **inputs))


def sky(scene):
    """A torus that turns over time, under a turned HDR, with an image on the floor."""
    width, height = 64, 32
    v, u = np.mgrid[0:height, 0:width]
    pixels = np.stack([0.2 + (u > 40) * 1.5, 0.3 + v / height, 0.2 + (u < 20) * 1.0, np.ones_like(u)], axis=2).astype(np.float32)
    image = bpy.data.images.new("sky", width, height, float_buffer=True)
    image.pixels.foreach_set(pixels[::-1].ravel())
    tree = scene.world.node_tree
    texture, mapping = tree.nodes.new("ShaderNodeTexEnvironment"), tree.nodes.new("ShaderNodeMapping")
    texture.image = image
    mapping.inputs["Rotation"].default_value[2] = 1.0
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs[0], tree.nodes["Background"].inputs["Color"])
    checker = bpy.data.images.new("checker", 16, 16)
    black = (np.indices((16, 16)).sum(axis=0) % 2)[..., None] * np.array([0.7, 0.7, 0.7, 0]) + np.array([0.1, 0.1, 0.1, 1])
    checker.pixels.foreach_set(black.astype(np.float32).ravel())
    floor = bpy.data.materials["floor"].node_tree
    picture = floor.nodes.new("ShaderNodeTexImage")
    picture.image, picture.interpolation = checker, "Closest"  # Cycles blends encoded texels
    floor.links.new(picture.outputs[0], next(n for n in floor.nodes if n.type == "BSDF_DIFFUSE").inputs["Color"])
    bpy.ops.mesh.primitive_torus_add(major_segments=64, minor_segments=32, location=(0, 0, 1.0), major_radius=1.0, minor_radius=0.4)
    torus = place(node_material("glass", "BsdfGlass", IOR=1.33, Roughness=0.0))
    torus.rotation_euler = (0.2, 0.0, 0.0)
    torus.keyframe_insert("rotation_euler", frame=1)
    torus.rotation_euler = (1.4, 0.3, 0.0)
    torus.keyframe_insert("rotation_euler", frame=3)
    scene.frame_set(2)


SCENES = {"ball": ball, "principled": principled, "sky": sky}


def picture(scene, engine, folder):
    scene.render.engine = engine
    scene.render.filepath = str(folder / f"{engine}.exr")
    bpy.ops.render.render(write_still=True)
    return pellucid.read_image(scene.render.filepath)[..., :3]


def measure(name, size, samples, folder):
    folder.mkdir(parents=True, exist_ok=True)
    scene = empty_scene()
    SCENES[name](scene)
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    cycles = scene.cycles
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = 4 * samples, False, False
    cycles.max_bounces = cycles.transmission_bounces = cycles.glossy_bounces = cycles.diffuse_bounces = 32
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.pixel_filter_type = "BOX"
    truth = picture(scene, "CYCLES", folder)
    cycles.seed = 7
    (folder / "CYCLES.exr").rename(folder / "truth.exr")
    noise = pellucid.flip(truth, picture(scene, "CYCLES", folder), hdr=False).mean()
    found = {"scene": name, "noise": float(noise)}
    for technique in ("path", "exact"):
        scene.pellucid.other_technique, scene.pellucid.light = technique, "full"
        scene.pellucid.samples = 4 * samples if technique == "path" else samples
        drawn = picture(scene, "PELLUCID", folder)
        (folder / "PELLUCID.exr").rename(folder / f"{technique}.exr")
        found[technique] = float(pellucid.flip(truth, drawn, hdr=False).mean())
        found[f"{technique}_mean"] = float(drawn.mean() / truth.mean())
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", choices=[*SCENES, []])
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--samples", type=int, default=32)
    parser.add_argument("--keep", type=Path)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    pellucid_engine.register()
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.scenes or SCENES:
            found = measure(name, arguments.size, arguments.samples, (arguments.keep or Path(folder)) / name)
            print("measured", json.dumps(found), flush=True)


main()
