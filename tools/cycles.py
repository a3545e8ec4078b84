"""Scenes for Cycles, the path tracer of Blender (Debian's package, 3.4), as Pellucid has them: what the tools that hold
the two against each other share. `render()` starts Blender, which runs this file to draw the job."""
import json
import math
import subprocess
import sys
from pathlib import Path


# --- Shapes ----------------------------------------------------------------------------------------

def sphere(rows=64):
    """A sphere of radius 1: vertices, which are their own normals, and triangles."""
    vertices = [(0.0, 1.0, 0.0), (0.0, -1.0, 0.0)]
    columns = 2 * rows
    for i in range(1, rows):
        theta = math.pi * i / rows
        for k in range(columns):
            phi = 2 * math.pi * k / columns
            vertices.append((math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi)))
    at = lambda i, k: 2 + (i - 1) * columns + k % columns
    triangles = []
    for k in range(columns):
        triangles.append((0, at(1, k + 1), at(1, k)))
        triangles.append((1, at(rows - 1, k), at(rows - 1, k + 1)))
        for i in range(1, rows - 1):
            triangles.append((at(i, k), at(i, k + 1), at(i + 1, k + 1)))
            triangles.append((at(i, k), at(i + 1, k + 1), at(i + 1, k)))
    return vertices, vertices, triangles


def read_obj(path):
    """Positions and triangles of a simple OBJ file."""
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    return vertices, triangles


def smooth_normals(vertices, triangles):
    """Normals of the triangles, weighted by their areas."""
    sums = [[0.0, 0.0, 0.0] for _ in vertices]
    for a, b, c in triangles:
        p, q, r = vertices[a], vertices[b], vertices[c]
        u, v = [q[i] - p[i] for i in range(3)], [r[i] - p[i] for i in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for corner in (a, b, c):
            for i in range(3):
                sums[corner][i] += normal[i]
    lengths = [math.hypot(*s) or 1.0 for s in sums]
    return [tuple(x / length for x in s) for s, length in zip(sums, lengths)]


# --- Light -----------------------------------------------------------------------------------------

def environment_radiance(x, y, z):
    """A room with two soft lamps and a bright patch: smooth, so that both interpolate it alike."""
    up = 0.5 + 0.5 * math.tanh(4 * y)
    colour = [0.16 + 0.14 * up, 0.15 + 0.20 * up, 0.13 + 0.34 * up]
    for direction, sharpness, light in (((0.6, 0.6, 0.53), 30, (6.0, 5.5, 5.0)), ((-0.8, 0.3, -0.52), 12, (1.0, 2.0, 3.0)),
                                        ((0.1, -0.2, -0.97), 40, (4.0, 1.0, 0.5))):
        length = math.hypot(*direction)
        cosine = (x * direction[0] + y * direction[1] + z * direction[2]) / length
        lobe = math.exp(sharpness * (cosine - 1))
        colour = [c + l * lobe for c, l in zip(colour, light)]
    return colour


def write_environment(path, width=512):
    """Radiance .hdr without compression: (x, y, z) at u = 1/2 + atan2(z, x) / 2 pi, v = acos(y) / pi."""
    height = width // 2
    texels = bytearray()
    for row in range(height):
        theta = (row + 0.5) / height * math.pi
        for column in range(width):
            phi = ((column + 0.5) / width - 0.5) * 2 * math.pi
            colour = environment_radiance(math.sin(theta) * math.cos(phi), math.cos(theta),
                                          math.sin(theta) * math.sin(phi))
            _, exponent = math.frexp(max(colour))
            texels += bytes(int(c * 256 / 2.0 ** exponent) for c in colour) + bytes([exponent + 128])
    head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    path.write_bytes(head.encode() + texels)


# --- Inside Blender --------------------------------------------------------------------------------

def material_in_blender(given):
    """`ior`: smooth glass, of that index over the one around it, and `absorption` within, per unit of length; `emission`,
    which nothing else lights; or `diffuse`, the albedo of a surface without a coat."""
    import bpy

    material = bpy.data.materials.new("material")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if "gltf" in given:
        import gltf_in_blender

        gltf_in_blender.build(nodes, links, output, given["gltf"])
        return material
    if "emission" in given:
        surface = nodes.new("ShaderNodeEmission")
        surface.inputs["Color"].default_value = (*given["emission"], 1)
    elif "diffuse" in given:
        surface = nodes.new("ShaderNodeBsdfDiffuse")
        surface.inputs["Color"].default_value = (*given["diffuse"], 1)
    else:
        surface = nodes.new("ShaderNodeBsdfGlass")
        surface.distribution = "SHARP"
        surface.inputs["Color"].default_value = (1, 1, 1, 1)
        surface.inputs["IOR"].default_value = given["ior"]
    links.new(surface.outputs[0], output.inputs["Surface"])
    density = max(given.get("absorption", [0]))
    if density > 0:
        volume = nodes.new("ShaderNodeVolumeAbsorption")
        volume.inputs["Color"].default_value = (*(1 - value / density for value in given["absorption"]), 1)
        volume.inputs["Density"].default_value = density
        links.new(volume.outputs[0], output.inputs["Volume"])
    return material


def add_map(world, file):
    import bpy

    texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(file)
    texture.image.colorspace_settings.name = "Linear"
    world.node_tree.links.new(texture.outputs[0], world.node_tree.nodes["Background"].inputs["Color"])


def render_in_blender(job):
    import bpy
    import mathutils

    y_up = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))  # to Blender's Z up
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)

    for number, given in enumerate(job["meshes"]):
        mesh = bpy.data.meshes.new(f"mesh {number}")
        mesh.from_pydata(given["vertices"], [], given["triangles"])
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.use_auto_smooth = True  # makes the normals that are set count
        mesh.normals_split_custom_set_from_vertices(given["normals"])
        if given.get("uv"):
            layer = mesh.uv_layers.new()
            layer.data.foreach_set("uv", [value for loop in mesh.loops for value in given["uv"][loop.vertex_index]])
        mesh.materials.append(material_in_blender(given["material"]))
        thing = bpy.data.objects.new(mesh.name, mesh)
        thing.matrix_world = y_up
        scene.collection.objects.link(thing)

    world = bpy.data.worlds.new("environment")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)
    if job["environment"]:
        add_map(world, job["environment"])
    scene.world = world
    for given in job.get("suns", []):
        sun = bpy.data.lights.new("sun", "SUN")
        sun.energy, sun.angle = given["irradiance"], given["angular_diameter"]
        thing = bpy.data.objects.new("sun", sun)
        to_light = -mathutils.Vector(given["direction"])
        thing.matrix_world = y_up @ to_light.to_track_quat("Z", "Y").to_matrix().to_4x4()
        scene.collection.objects.link(thing)

    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(job["fov_deg"])
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    eye = bpy.data.objects.new("camera", camera)
    eye.matrix_world = y_up @ mathutils.Matrix(job["world_from_view"])
    scene.collection.objects.link(eye)
    scene.camera = eye

    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.exr_codec = "ZIP"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["samples"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 1024
    cycles.transparent_max_bounces = 1024
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.pixel_filter_type = "BOX"
    for run, path in enumerate(job["pictures"]):
        cycles.seed = run + job.get("first_seed", 1)
        scene.render.filepath = path
        bpy.ops.render.render(write_still=True)


# --- Outside ---------------------------------------------------------------------------------------

def orbit(vertices, view):
    """World from view, as `--camera orbit:` places it around the centre of the bounding box. `view`: azimuth and
    elevation in degrees, distance in bounding radii."""
    low = [min(v[i] for v in vertices) for i in range(3)]
    high = [max(v[i] for v in vertices) for i in range(3)]
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    radius = max(math.dist(v, centre) for v in vertices)
    azimuth, elevation = math.radians(view[0]), math.radians(view[1])
    right = (math.cos(azimuth), 0.0, -math.sin(azimuth))
    back = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), math.cos(azimuth) * math.cos(elevation))
    up = (back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2],
          back[0] * right[1] - back[1] * right[0])
    eye = [c + view[2] * radius * b for c, b in zip(centre, back)]
    return [[right[i], up[i], back[i], eye[i]] for i in range(3)] + [[0, 0, 0, 1]]


def run(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command[:3]))} ... failed:\n{done.stdout[-2000:]}")
    return done.stdout


def render(blender, job, job_file, threads=None):
    """Lets Cycles draw `job`: meshes (vertices, normals, triangles, material), environment (a file; None: dark), suns
    (direction, irradiance in W/m2, angular_diameter in radians; none if left out), world_from_view, fov_deg, size, samples, and the pictures, one for each seed from `first_seed` (1) on."""
    job_file.write_text(json.dumps(job))
    run([blender, "--background", "--factory-startup", "--python-exit-code", "1",
         *(["--threads", str(threads)] if threads else []), "--python", __file__, "--", str(job_file)])


def version(blender):
    try:
        return run([blender, "--version"]).splitlines()[0]
    except FileNotFoundError:
        sys.exit(f"{blender}: no such program (Debian: apt-get install --no-install-recommends blender)")


if "bpy" in sys.modules:
    sys.path.append(str(Path(__file__).resolve().parent))
    render_in_blender(json.loads(Path(sys.argv[-1]).read_text()))
