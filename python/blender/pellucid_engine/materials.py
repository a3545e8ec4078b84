"""Node trees of Blender as materials of Pellucid. What has no counterpart is named in a warning."""
import math

import numpy as np
import pellucid


def linked_node(socket):
    """The node behind a socket, past reroutes; None where a value is typed in."""
    while socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def reflectance(ior):
    return ((ior - 1.0) / (ior + 1.0)) ** 2


def ior_of_reflectance(f0):
    root = math.sqrt(min(max(f0, 0.0), 0.9))
    return (1.0 + root) / (1.0 - root)


class Materials:
    """Adds the materials of a scene, each once."""

    def __init__(self, scene, warn):
        self.scene, self.warn = scene, warn
        self.known, self.images = {}, {}

    def index(self, material):
        key = material.name_full if material else None
        if key not in self.known:
            self.known[key] = self.scene.add_material(self.converted(material) if material else plain((0.8, 0.8, 0.8)))
        return self.known[key]

    def converted(self, material):
        self.user = f"material {material.name}"
        tree = material.node_tree if material.use_nodes else None
        output = tree.get_output_node("ALL") if tree else None
        if output is None:
            return plain(tuple(material.diffuse_color)[:3])
        surface = linked_node(output.inputs["Surface"])
        if surface is None:
            self.warn(f"{self.user}: it has no surface; it is drawn as a matt grey one")
            return plain((0.8, 0.8, 0.8))
        given = self.surface(surface)
        given["name"] = material.name
        volume = linked_node(output.inputs["Volume"])
        if volume is not None and given.get("thickness"):
            given.update(self.volume(volume))
        return pellucid.Material(**given)

    # --- surfaces -------------------------------------------------------------------------------------

    def surface(self, node):
        maker = getattr(self, node.type.lower(), None)
        if maker is None:
            self.warn(f"{self.user}: {node.bl_label} is not known; it is drawn as a matt grey surface")
            return matt((0.8, 0.8, 0.8))
        return maker(node)

    def bsdf_principled(self, node):
        value = lambda name: self.value(node.inputs[name])
        transmission = value("Transmission")
        given = {"roughness": value("Roughness"), "metallic": value("Metallic"), "transmission": transmission}
        given |= self.color(node.inputs["Base Color"])
        if transmission > 0.0:
            given |= self.glass_color(given, value("IOR"))
        else:
            given["ior"] = ior_of_reflectance(0.08 * value("Specular"))
        alpha = value("Alpha")
        if alpha < 1.0 or node.inputs["Alpha"].is_linked:
            given["base_color"] = (*given["base_color"][:3], alpha)
            given["alpha_is_coverage"] = True
        coat = value("Clearcoat")
        if coat > 0.0 and transmission == 0.0:
            given["finish"] = pellucid.Finish(clearcoat=min(coat, 1.0), clearcoat_roughness=value("Clearcoat Roughness"))
        emission = np.array(self.rgb(node.inputs["Emission"])) * value("Emission Strength")
        if emission.max() > 0.0:
            given["emission"] = emission
        if node.inputs["Normal"].is_linked:
            self.warn(f"{self.user}: its normal or bump map is left out")
        return given

    def bsdf_glass(self, node):
        given = {"transmission": 1.0, "roughness": self.value(node.inputs["Roughness"])}
        if node.distribution == "SHARP":
            given["roughness"] = 0.0
        given |= self.color(node.inputs["Color"])
        return given | self.glass_color(given, self.value(node.inputs["IOR"]))

    def bsdf_refraction(self, node):
        self.warn(f"{self.user}: a refraction node is drawn as glass, with the reflections that go with it")
        return self.bsdf_glass(node)

    def bsdf_diffuse(self, node):
        return matt((0, 0, 0)) | self.color(node.inputs["Color"])

    def bsdf_glossy(self, node):
        roughness = 0.0 if node.distribution == "SHARP" else self.value(node.inputs["Roughness"])
        return {"metallic": 1.0, "roughness": roughness} | self.color(node.inputs["Color"])

    def bsdf_transparent(self, node):
        return matt((0, 0, 0)) | {"base_color": (0.0, 0.0, 0.0, 0.0), "alpha_is_coverage": True}

    def emission(self, node):
        strength = self.value(node.inputs["Strength"])
        return matt((0, 0, 0)) | {"emission": np.array(self.rgb(node.inputs["Color"])) * strength}

    def mix_shader(self, node):
        """The larger part; of a mixture with transparency, coverage."""
        share = self.value(node.inputs[0])
        parts = [linked_node(socket) for socket in node.inputs[1:3]]
        for part, other, covers in ((parts[0], parts[1], share), (parts[1], parts[0], 1.0 - share)):
            if part is not None and part.type == "BSDF_TRANSPARENT" and other is not None:
                given = self.surface(other)
                return given | {"base_color": (*given["base_color"][:3], covers), "alpha_is_coverage": True}
        self.warn(f"{self.user}: of a mixture of two surfaces the larger part is drawn")
        chosen = parts[1] if share >= 0.5 else parts[0]
        return self.surface(chosen) if chosen is not None else matt((0, 0, 0))

    def glass_color(self, given, ior):
        """Blender tints at both boundaries; the base colour here counts once on the way through."""
        red, green, blue, alpha = given["base_color"]
        return {"base_color": (red * red, green * green, blue * blue, alpha), "ior": ior, "thickness": 1.0}

    # --- volumes --------------------------------------------------------------------------------------

    def volume(self, node):
        if node.type == "VOLUME_ABSORPTION":
            sigma = self.value(node.inputs["Density"]) * (1.0 - np.array(self.rgb(node.inputs["Color"])))
        elif node.type == "PRINCIPLED_VOLUME":
            color = np.array(self.rgb(node.inputs["Color"]))
            sigma = self.value(node.inputs["Density"]) * (1.0 - color)
            if color.max() > 0.0:
                self.warn(f"{self.user}: its volume scatters, which is left out; what it absorbs is drawn")
        else:
            self.warn(f"{self.user}: {node.bl_label} is left out")
            return {}
        sigma = np.maximum(sigma, 0.0)
        if sigma.max() <= 0.0:
            return {}
        distance = 1.0 / sigma.max()
        return {"attenuation_distance": distance, "attenuation_color": np.exp(-sigma * distance)}

    # --- values ---------------------------------------------------------------------------------------

    def value(self, socket):
        node = linked_node(socket)
        if node is not None and node.type == "VALUE":
            return float(node.outputs[0].default_value)
        if node is not None:
            self.warn(f"{self.user}: {socket.name} comes from {node.bl_label}, which is not known; {socket.default_value:g} is used")
        return float(socket.default_value)

    def rgb(self, socket):
        node = linked_node(socket)
        if node is not None and node.type == "RGB":
            return tuple(node.outputs[0].default_value)[:3]
        if node is not None:
            self.warn(f"{self.user}: {socket.name} comes from {node.bl_label}, which is not known; its plain colour is used")
        return tuple(socket.default_value)[:3]

    def color(self, socket):
        """A colour, or an image over the first texture coordinates."""
        node = linked_node(socket)
        if node is None or node.type != "TEX_IMAGE" or node.image is None:
            return {"base_color": (*self.rgb(socket), 1.0)}
        if linked_node(node.inputs["Vector"]) not in (None,) and linked_node(node.inputs["Vector"]).type not in ("TEX_COORD", "UVMAP"):
            self.warn(f"{self.user}: the placement of image {node.image.name} is left out")
        wrap = {"EXTEND": "clamp", "CLIP": "clamp"}.get(node.extension, "repeat")
        texture = pellucid.Texture(image=self.image(node.image), wrap_u=wrap, wrap_v=wrap,
                                   nearest=node.interpolation == "Closest")
        return {"base_color": (1.0, 1.0, 1.0, 1.0), "base_color_texture": texture}

    def image(self, image):
        if image.name_full not in self.images:
            pixels = pixels_of(image)
            if image.is_float or image.colorspace_settings.name not in ("sRGB", "Filmic sRGB"):
                # Colours of textures are stored as sRGB.
                rgb = np.clip(pixels[..., :3], 0.0, 1.0)
                pixels[..., :3] = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
            self.images[image.name_full] = self.scene.add_image(np.clip(pixels, 0.0, 1.0), image.name)
        return self.images[image.name_full]


def pixels_of(image):
    """float32 (height, width, 4), rows from the top."""
    width, height = image.size
    if width * height == 0:
        raise pellucid.Error(f"image {image.name}: it cannot be read")
    pixels = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, image.channels)[::-1]
    if image.channels == 4:
        return pixels.copy()
    rgb = pixels[..., :3] if image.channels == 3 else np.repeat(pixels[..., :1], 3, axis=2)
    return np.concatenate([rgb, np.ones((height, width, 1), dtype=np.float32)], axis=2)


def matt(color):
    """Diffuse without a coat."""
    return {"base_color": (*color, 1.0), "roughness": 1.0, "ior": 1.0}


def plain(color):
    return pellucid.Material(**matt(color))
