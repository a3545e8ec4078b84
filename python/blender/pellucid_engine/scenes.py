"""What Blender shows, as a scene, a camera and an environment of Pellucid. Blender's Z is up; here Y is."""
import math

import numpy as np
import pellucid

from .materials import Materials, linked_node, pixels_of

Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
GEOMETRY = {"MESH", "CURVE", "SURFACE", "META", "FONT"}


class Export:
    """Scene and environment of a dependency graph; `warnings` names what is left out."""

    def __init__(self, depsgraph):
        self.warnings, self.scene = [], pellucid.Scene()
        self.materials = Materials(self.scene, self.warn)
        self.meshes, self.bodies = {}, 0
        for instance in depsgraph.object_instances:
            if instance.show_self:
                self.add(instance, depsgraph)
        self.environment = self.world(depsgraph.scene.world)

    def warn(self, text):
        if text not in self.warnings:
            self.warnings.append(text)

    def add(self, instance, depsgraph):
        thing = instance.object
        world = Y_UP @ np.array(instance.matrix_world)
        if thing.type in GEOMETRY:
            self.add_geometry(thing, world, depsgraph)
        elif thing.type == "LIGHT":
            self.add_light(thing, world)
        elif thing.type == "VOLUME":
            self.warn(f"{thing.name}: volume objects are left out")

    # --- meshes ---------------------------------------------------------------------------------------

    def add_geometry(self, thing, world, depsgraph):
        if abs(np.linalg.det(world[:3, :3])) < 1e-20:
            return self.warn(f"{thing.name}: its scale is zero; it is left out")
        key = thing.name_full
        if key not in self.meshes:
            self.meshes[key] = self.parts_of(thing, depsgraph)
        body = -1
        if len(self.meshes[key]) > 1:  # parts of one solid
            body, self.bodies = self.bodies, self.bodies + 1
        for mesh, material in self.meshes[key]:
            self.scene.add_object(mesh, material, world, thing.name, body)

    def parts_of(self, thing, depsgraph):
        """Pairs of mesh and material, one for every material slot in use."""
        mesh = thing.to_mesh(preserve_all_data_layers=False, depsgraph=depsgraph)
        try:
            if mesh is None or len(mesh.polygons) == 0:
                return []
            mesh.calc_loop_triangles()
            mesh.calc_normals_split()
            corners = values(mesh.loop_triangles, "loops", 3, np.int32)
            slots = values(mesh.loop_triangles, "material_index", 1, np.int32).ravel()
            vertices = values(mesh.loops, "vertex_index", 1, np.int32).ravel()
            positions = values(mesh.vertices, "co", 3)[vertices]
            normals = values(mesh.loops, "normal", 3)
            texcoords = values(mesh.uv_layers.active.data, "uv", 2) if mesh.uv_layers.active else None
            if texcoords is not None:
                texcoords[:, 1] = 1.0 - texcoords[:, 1]
            used = [slot.material for slot in thing.material_slots] or list(mesh.materials)
            parts = []
            for slot in np.unique(slots):
                chosen, faces = np.unique(corners[slots == slot], return_inverse=True)
                index = self.scene.add_mesh(positions[chosen], faces.reshape(-1, 3), normals[chosen],
                                            texcoords[chosen] if texcoords is not None else None, name=thing.name)
                parts.append((index, self.materials.index(used[slot] if slot < len(used) else None)))
            return parts
        finally:
            thing.to_mesh_clear()

    # --- light ----------------------------------------------------------------------------------------

    def add_light(self, thing, world):
        lamp = thing.data
        if lamp.use_nodes:
            self.warn(f"{thing.name}: nodes of lamps are left out; its colour and power are used")
        color, along = np.array(lamp.color), -world[:3, 2] / np.linalg.norm(world[:3, 2])
        if lamp.type == "SUN":
            return self.scene.add_light(pellucid.Light(kind="directional", name=thing.name, direction=along,
                                                       intensity=color * lamp.energy, angular_diameter=lamp.angle))
        if lamp.type == "AREA":
            return self.add_area(thing, world, color)
        given = {"name": thing.name, "position": world[:3, 3], "radius": lamp.shadow_soft_size,
                 "intensity": color * lamp.energy / (4.0 * math.pi)}
        if lamp.type == "POINT":
            return self.scene.add_light(pellucid.Light(kind="point", **given))
        outer = 0.5 * lamp.spot_size
        return self.scene.add_light(pellucid.Light(kind="spot", direction=along, outer_cone_angle=outer,
                                                   inner_cone_angle=outer * (1.0 - lamp.spot_blend), **given))

    def add_area(self, thing, world, color):
        """A glowing rectangle or ellipse, which is seen, too."""
        lamp = thing.data
        sides = np.array([lamp.size, lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size])
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        if lamp.shape in ("DISK", "ELLIPSE"):
            angles = np.arange(32) * math.tau / 32
            corners = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        flat = np.zeros((len(corners), 3))
        flat[:, :2] = 0.5 * corners * sides
        faces = [(0, i + 1, i) for i in range(1, len(corners) - 1)]  # light leaves along -Z
        placed = flat @ world[:3, :3].T
        area = 0.5 * np.linalg.norm(sum(np.cross(placed[i], placed[(i + 1) % len(placed)]) for i in range(len(placed))))
        if area <= 0.0:
            return self.warn(f"{thing.name}: its area is zero; it is left out")
        self.warn(f"{thing.name}: an area lamp is drawn as a glowing surface, which the camera sees")
        glow = pellucid.Material(name=thing.name, base_color=(0, 0, 0, 1), roughness=1.0, ior=1.0,
                                 emission=color * lamp.energy / (math.pi * area))
        mesh = self.scene.add_mesh(flat, faces, np.tile((0.0, 0.0, -1.0), (len(flat), 1)), name=thing.name)
        return self.scene.add_object(mesh, self.scene.add_material(glow), world, thing.name)

    def world(self, world):
        if world is None:
            return constant((0.0, 0.0, 0.0))
        if not world.use_nodes:
            return constant(tuple(world.color))
        output = next((n for n in world.node_tree.nodes if n.type == "OUTPUT_WORLD" and n.is_active_output), None)
        background = linked_node(output.inputs["Surface"]) if output else None
        if background is None or background.type != "BACKGROUND":
            if background is not None:
                self.warn(f"world: {background.bl_label} is not known; it is drawn black")
            return constant((0.0, 0.0, 0.0))
        strength = float(background.inputs["Strength"].default_value)
        node = linked_node(background.inputs["Color"])
        if node is None or node.type != "TEX_ENVIRONMENT" or node.image is None:
            if node is not None:
                self.warn(f"world: {node.bl_label} is not known; its plain colour is used")
            return constant(np.array(background.inputs["Color"].default_value)[:3] * strength)
        pixels = pixels_of(node.image)[..., :3]
        if not node.image.is_float:
            pixels = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
        return pellucid.Environment(np.ascontiguousarray(pixels), rotation=-self.turn_of(node), intensity=strength)

    def turn_of(self, node):
        """Of a mapping node about the vertical axis."""
        mapping = linked_node(node.inputs["Vector"])
        if mapping is None or mapping.type != "MAPPING":
            return 0.0
        turn = np.array(mapping.inputs["Rotation"].default_value)
        if abs(turn[0]) > 1e-6 or abs(turn[1]) > 1e-6:
            self.warn("world: turns about other axes than the vertical one are left out")
        return float(turn[2])


def constant(color):
    return pellucid.Environment(np.tile(np.array(color, dtype=np.float32), (2, 4, 1)))


def values(collection, name, columns, dtype=np.float32):
    """Attribute of all elements, shape (count, columns)."""
    found = np.empty(len(collection) * columns, dtype=dtype)
    collection.foreach_get(name, found)
    return found.reshape(-1, columns)


def camera_of(matrix_world, projection, near, far, warn):
    """`projection`: Blender's 4x4 window matrix, whose element (1, 1) is the cotangent of half the field of view."""
    world = Y_UP @ np.array(matrix_world)
    world[:3, :3] /= np.linalg.norm(world[:3, :3], axis=0)
    projection = np.array(projection)
    if abs(projection[0, 2]) + abs(projection[1, 2]) > 1e-4 or projection[3, 3] == 1.0 and np.abs(projection[:2, 3]).max() > 1e-4:
        warn("camera: its shift is left out")
    given = {"world_from_view": world, "near_plane": max(near, 1e-6), "far_plane": far}
    if projection[3, 3] == 1.0:
        return pellucid.Camera(orthographic=True, vertical_extent=2.0 / projection[1, 1], **given)
    return pellucid.Camera(vertical_fov=2.0 * math.atan(1.0 / projection[1, 1]), **given)
