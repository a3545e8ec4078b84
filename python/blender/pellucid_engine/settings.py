"""What a scene says about its renders, and the panels that show it."""
import bpy

TECHNIQUES = [("fast", "Fast", "Quick frames of one or two refractions"),
              ("balanced", "Balanced", "Most of what light does, at interactive rates"),
              ("exact", "Exact", "Every refraction and reflection that the device can follow"),
              ("path", "Path traced", "All light, by chance: slow, and the truth that others are measured against")]
LIGHT = [("automatic", "Automatic", "All light in stills of 8 samples or more, else direct light"),
         ("environment", "World only", "The world lights surfaces; lamps do not"),
         ("direct", "Direct", "Lamps with shadows, and the world"),
         ("full", "Full", "Also what surfaces send to each other, and caustics")]


class PellucidSettings(bpy.types.PropertyGroup):
    technique: bpy.props.EnumProperty(name="Technique", items=TECHNIQUES, default="balanced")
    other_technique: bpy.props.StringProperty(
        name="By name", description="Name of another technique, as `pellucid techniques` lists them; takes precedence")
    samples: bpy.props.IntProperty(name="Samples", default=32, min=1, max=65536, description="Jittered frames, averaged")
    viewport_samples: bpy.props.IntProperty(name="Viewport", default=16, min=1, max=65536,
                                            description="Samples after which the viewport rests")
    light: bpy.props.EnumProperty(name="Light", items=LIGHT, default="automatic")
    passes: bpy.props.StringProperty(
        name="Passes", description="Further quantities per pixel, with commas between: depth, normal, events, caustic, ...")

    def technique_name(self):
        return self.other_technique.strip() or self.technique

    def pass_names(self):
        return [name.strip() for name in self.passes.split(",") if name.strip()]


class RENDER_PT_pellucid(bpy.types.Panel):
    bl_label = "Pellucid"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "render"
    COMPAT_ENGINES = {"PELLUCID"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw(self, context):
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("technique", "other_technique", "light", "samples", "viewport_samples", "passes"):
            layout.prop(context.scene.pellucid, name)


CLASSES = (PellucidSettings, RENDER_PT_pellucid)


def register():
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.pellucid = bpy.props.PointerProperty(type=PellucidSettings)


def unregister():
    del bpy.types.Scene.pellucid
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
