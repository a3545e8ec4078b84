"""Materials of gltf_for_cycles.py as node trees; runs inside Blender (3.4)."""
import math


class Builder:
    def __init__(self, nodes, links):
        self.nodes, self.links = nodes, links

    def node(self, kind, **inputs):
        node = self.nodes.new("ShaderNode" + kind)
        for name, value in inputs.items():
            self.give(node.inputs[name.replace("_", " ")], value)
        return node

    def give(self, socket, value):
        """A number, a colour, or another node's output."""
        if hasattr(value, "is_output"):
            self.links.new(value, socket)
        elif isinstance(value, (list, tuple)) and len(value) == 3 and socket.type == "RGBA":
            socket.default_value = (*value, 1)
        else:
            socket.default_value = value

    def math(self, operation, a, b):
        node = self.node("Math")
        node.operation = operation
        self.give(node.inputs[0], a)
        self.give(node.inputs[1], b)
        return node.outputs[0]

    def product(self, a, b):
        node = self.node("MixRGB", Fac=1.0)
        node.blend_type = "MULTIPLY"
        self.give(node.inputs["Color1"], a)
        self.give(node.inputs["Color2"], b)
        return node.outputs[0]

    def mix(self, share, a, b):
        node = self.node("MixShader")
        self.give(node.inputs[0], share)
        self.links.new(a, node.inputs[1])
        self.links.new(b, node.inputs[2])
        return node.outputs[0]

    def add(self, a, b):
        node = self.node("AddShader")
        self.links.new(a, node.inputs[0])
        self.links.new(b, node.inputs[1])
        return node.outputs[0]

    def fresnel(self, ior, **tilt):
        """What either face reflects. Cycles takes a face seen from behind for one seen from inside, with 1 / ior."""
        behind = self.node("NewGeometry").outputs["Backfacing"]
        power = self.math("SUBTRACT", 1.0, self.math("MULTIPLY", behind, 2.0))
        return self.node("Fresnel", IOR=self.math("POWER", ior, power), **tilt).outputs[0]

    def image(self, texture, colour):
        """Texture coordinates with v upwards."""
        import bpy

        node, mapping = self.node("TexImage"), self.node("Mapping")
        node.image = bpy.data.images.load(texture["file"], check_existing=False)
        node.image.colorspace_settings.name = "sRGB" if colour else "Non-Color"
        node.image.alpha_mode = "CHANNEL_PACKED"
        (u, v), (su, sv) = texture["offset"], texture["scale"]
        mapping.inputs["Location"].default_value = (u, 1 - sv - v, 0)
        mapping.inputs["Scale"].default_value = (su, sv, 1)
        self.links.new(self.node("TexCoord").outputs["UV"], mapping.inputs["Vector"])
        self.links.new(mapping.outputs[0], node.inputs["Vector"])
        return node


def factors(b, given):
    """Metallic value and roughness, whose square Blender takes for the width of facets, as glTF does."""
    metallic, roughness = given["metallic"], given["roughness"]
    if given["factors_texture"]:
        parts = b.node("SeparateRGB", Image=b.image(given["factors_texture"], False).outputs["Color"])
        metallic = b.math("MULTIPLY", parts.outputs["B"], metallic)
        roughness = b.math("MULTIPLY", parts.outputs["G"], roughness)
    return metallic, roughness


def thin_glass(b, base, given):
    """Both faces of a pane: 2 R / (1 + R) is reflected, the rest goes straight on."""
    r = b.fresnel(given["ior"])
    both = b.math("DIVIDE", b.math("MULTIPLY", r, 2.0), b.math("ADD", r, 1.0))
    mirror = b.node("BsdfGlossy", Color=(1, 1, 1), Roughness=factors(b, given)[1]).outputs[0]
    return b.mix(both, b.node("BsdfTransparent", Color=base).outputs[0], mirror)


def solid_glass(b, base, given):
    """The base colour counts once on the way through; a boundary's colour counts twice."""
    root = b.node("Gamma", Color=base, Gamma=0.5).outputs[0]
    roughness = factors(b, given)[1]
    glass = b.node("BsdfGlass", Color=root, IOR=given["ior"], Roughness=roughness)
    glass.distribution = "SHARP" if roughness == 0 else "GGX"
    return glass.outputs[0]


def opaque(b, base, given):
    """glTF's layers: a coat over a metal, or over a diffuse surface under a dielectric. The Principled BSDF would not do: its diffuse
    part reflects more towards grazing angles, 20% in the mean on a rough floor, and keeps what its specular part reflects."""
    metallic, roughness = factors(b, given)
    tilt = {}
    if given["normal_texture"]:
        tilt["Normal"] = b.node("NormalMap", Strength=given["normal_texture"]["strength"],
                                Color=b.image(given["normal_texture"], False).outputs["Color"]).outputs[0]
    dielectric = b.mix(b.fresnel(given["ior"], **tilt),
                       b.node("BsdfDiffuse", Color=base, **tilt).outputs[0],
                       b.node("BsdfGlossy", Color=(1, 1, 1), Roughness=roughness, **tilt).outputs[0])
    surface = b.mix(metallic, dielectric, b.node("BsdfGlossy", Color=base, Roughness=roughness, **tilt).outputs[0])
    if given["coat"] > 0:
        reflected = b.math("MULTIPLY", b.fresnel(1.5), given["coat"])
        surface = b.mix(reflected, surface,
                        b.node("BsdfGlossy", Color=(1, 1, 1), Roughness=given["coat_roughness"]).outputs[0])
    if max(given["emission"]) > 0:
        emission = tuple(given["emission"])
        if given["emission_texture"]:
            emission = b.product(emission, b.image(given["emission_texture"], True).outputs["Color"])
        surface = b.add(surface, b.node("Emission", Color=emission).outputs[0])
    return surface


def build(nodes, links, output, given):
    b = Builder(nodes, links)
    base, alpha = tuple(given["base"][:3]), given["base"][3]
    if given["base_texture"]:
        image = b.image(given["base_texture"], True)
        base = b.product(base, image.outputs["Color"])
        alpha = b.math("MULTIPLY", image.outputs["Alpha"], alpha)
    if given["unlit"]:
        surface = b.node("Emission", Color=base).outputs[0]
    elif given["transmission"] > 0:
        surface = (solid_glass if given["solid"] else thin_glass)(b, base, given)
    else:
        surface = opaque(b, base, given)
    if given["alpha"] != "OPAQUE" and given["transmission"] == 0:
        covers = alpha if given["alpha"] == "BLEND" else b.math("GREATER_THAN", alpha, given["cutoff"])
        surface = b.mix(covers, b.node("BsdfTransparent").outputs[0], surface)
    links.new(surface, output.inputs["Surface"])
    density = max(given["absorption"])
    if given["solid"] and density > 0 and math.isfinite(density):
        volume = b.node("VolumeAbsorption", Density=density,
                        Color=tuple(1 - value / density for value in given["absorption"]))
        links.new(volume.outputs[0], output.inputs["Volume"])
