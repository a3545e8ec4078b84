"""Reads glTF 2.0 files into meshes for cycles.py: triangles in the world's frame with normals, the first texture
coordinates, and a material's factors and textures. Only what the files of compare_files_with_cycles use."""
import base64
import json
import math
import struct
from urllib.parse import unquote

FORMATS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
LARGEST = {5120: 127.0, 5121: 255.0, 5122: 32767.0, 5123: 65535.0}


def product(a, b):
    """Of 4x4 matrices in columns."""
    return [sum(a[4 * k + row] * b[4 * column + k] for k in range(4)) for column in range(4) for row in range(4)]


def placement(node):
    if "matrix" in node:
        return node["matrix"]
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    sx, sy, sz = node.get("scale", (1, 1, 1))
    return [sx * (1 - 2 * (y * y + z * z)), sx * 2 * (x * y + z * w), sx * 2 * (x * z - y * w), 0,
            sy * 2 * (x * y - z * w), sy * (1 - 2 * (x * x + z * z)), sy * 2 * (y * z + x * w), 0,
            sz * 2 * (x * z + y * w), sz * 2 * (y * z - x * w), sz * (1 - 2 * (x * x + y * y)), 0,
            *node.get("translation", (0, 0, 0)), 1]


def cofactors(m):
    """What normals go with, up to length, where m does not mirror."""
    a, b, c = m[0:3], m[4:7], m[8:11]
    cross = lambda u, v: [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    return cross(b, c), cross(c, a), cross(a, b)


class Gltf:
    def __init__(self, path, folder):
        """`folder` gets the images that the file has inside."""
        self.path, self.folder = path, folder
        data, self.binary = path.read_bytes(), b""
        if data[:4] == b"glTF":
            length = struct.unpack_from("<I", data, 12)[0]
            self.json = json.loads(data[20:20 + length])
            self.binary = data[28 + length:]
        else:
            self.json = json.loads(data)
        self.buffers = [self.read(buffer.get("uri")) for buffer in self.json.get("buffers", [])]

    def read(self, uri):
        if uri is None:
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        return (self.path.parent / unquote(uri)).read_bytes()

    def view(self, index):
        view = self.json["bufferViews"][index]
        begin = view.get("byteOffset", 0)
        return self.buffers[view["buffer"]][begin:begin + view["byteLength"]], view.get("byteStride", 0)

    def accessor(self, index):
        accessor = self.json["accessors"][index]
        data, stride = self.view(accessor["bufferView"])
        count, kind = COMPONENTS[accessor["type"]], accessor["componentType"]
        layout = struct.Struct(f"<{count}{FORMATS[kind]}")
        begin, stride = accessor.get("byteOffset", 0), stride or layout.size
        rows = [layout.unpack_from(data, begin + i * stride) for i in range(accessor["count"])]
        if accessor.get("normalized"):
            rows = [tuple(max(value / LARGEST[kind], -1.0) for value in row) for row in rows]
        return rows

    def texture(self, info):
        """File, offset and scale of a textureInfo; None without one."""
        if info is None:
            return None
        number = self.json["textures"][info["index"]]["source"]
        image = self.json["images"][number]
        if "uri" in image and not image["uri"].startswith("data:"):
            file = self.path.parent / unquote(image["uri"])
        else:
            data = self.view(image["bufferView"])[0] if "bufferView" in image else self.read(image["uri"])
            file = self.folder / f"image{number}.{'jpg' if data[:2] == bytes([255, 216]) else 'png'}"
            file.write_bytes(data)
        transform = info.get("extensions", {}).get("KHR_texture_transform", {})
        assert info.get("texCoord", 0) == 0 and "rotation" not in transform, f"{self.path}: texture coordinates"
        return {"file": str(file.resolve()), "offset": transform.get("offset", (0, 0)),
                "scale": transform.get("scale", (1, 1)), "strength": info.get("scale", 1.0)}

    def material(self, index):
        given = self.json["materials"][index] if index is not None else {}
        pbr, extensions = given.get("pbrMetallicRoughness", {}), given.get("extensions", {})
        extension = lambda name: extensions.get(f"KHR_materials_{name}", {})
        coat, volume, emission = extension("clearcoat"), extension("volume"), extension("emissive_strength")
        strength = emission.get("emissiveStrength", 1.0)
        colour = volume.get("attenuationColor", (1, 1, 1))
        distance = volume.get("attenuationDistance", math.inf)
        return {"base": pbr.get("baseColorFactor", (1, 1, 1, 1)), "base_texture": self.texture(pbr.get("baseColorTexture")),
                "metallic": pbr.get("metallicFactor", 1.0), "roughness": pbr.get("roughnessFactor", 1.0),
                "factors_texture": self.texture(pbr.get("metallicRoughnessTexture")),
                "normal_texture": self.texture(given.get("normalTexture")),
                "emission": [strength * value for value in given.get("emissiveFactor", (0, 0, 0))],
                "emission_texture": self.texture(given.get("emissiveTexture")),
                "alpha": given.get("alphaMode", "OPAQUE"), "cutoff": given.get("alphaCutoff", 0.5),
                "coat": coat.get("clearcoatFactor", 0.0), "coat_roughness": coat.get("clearcoatRoughnessFactor", 0.0),
                "unlit": "KHR_materials_unlit" in extensions,
                "ior": extension("ior").get("ior", 1.5),
                "transmission": extension("transmission").get("transmissionFactor", 0.0),
                "solid": volume.get("thicknessFactor", 0.0) > 0,
                "absorption": [-math.log(max(c, 1e-6)) / distance for c in colour]}

    def meshes(self):
        """Every primitive of triangles, in the world."""
        found = []

        def visit(index, above):
            node = self.json["nodes"][index]
            world = product(above, placement(node))
            if "mesh" in node:
                for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                    found.append(self.primitive(primitive, world))
            for child in node.get("children", []):
                visit(child, world)

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            visit(root, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
        return found

    def primitive(self, given, world):
        assert given.get("mode", 4) == 4, f"{self.path}: triangles alone are read here"
        attributes, turn = given["attributes"], cofactors(world)
        positions = self.accessor(attributes["POSITION"])
        move = lambda p: tuple(sum(world[4 * k + row] * p[k] for k in range(3)) + world[12 + row] for row in range(3))

        def turned(n):
            n = [sum(turn[k][row] * n[k] for k in range(3)) for row in range(3)]
            length = math.hypot(*n) or 1.0
            return tuple(value / length for value in n)

        indices = [row[0] for row in self.accessor(given["indices"])] if "indices" in given else list(range(len(positions)))
        uv = self.accessor(attributes["TEXCOORD_0"]) if "TEXCOORD_0" in attributes else []
        return {"vertices": [move(p) for p in positions],
                "normals": [turned(n) for n in self.accessor(attributes["NORMAL"])],
                "triangles": list(zip(indices[0::3], indices[1::3], indices[2::3])),
                "uv": [(u, 1.0 - v) for u, v in uv], "material": {"gltf": self.material(given.get("material"))}}
