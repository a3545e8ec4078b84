"""The render engine: final renders, and the viewport sample by sample."""
import weakref

import bpy
import gpu
import numpy as np
import pellucid
from gpu_extras.presets import draw_texture_2d

from .scenes import Export, camera_of

CHANNELS = {1: ("X", "VALUE"), 2: ("XY", "VECTOR"), 3: ("XYZ", "VECTOR")}
LIGHT_PASSES = {"emitted", "direct", "caustic", "indirect"}


class Cancelled(Exception):
    pass


class PellucidEngine(bpy.types.RenderEngine):
    bl_idname = "PELLUCID"
    bl_label = "Pellucid"
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    # --- final renders --------------------------------------------------------------------------------

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        known = pellucid.aovs()
        for name in scene.pellucid.pass_names():
            if name in known:
                self.register_pass(scene, renderlayer, name, *channels_of(name, known[name][0]))

    def render(self, depsgraph):
        scene = depsgraph.scene
        scale = scene.render.resolution_percentage / 100.0
        width, height = int(scene.render.resolution_x * scale), int(scene.render.resolution_y * scale)
        try:
            frame, warnings = self.frame(depsgraph, width, height)
        except Cancelled:
            return
        except (pellucid.Error, pellucid.DeviceError) as error:
            self.report({"ERROR"}, str(error))
            self.error_set(str(error))
            return
        for warning in warnings:
            self.report({"WARNING"}, warning)
        result = self.begin_result(0, 0, width, height)
        write_pass(result, "Combined", with_alpha(frame.radiance))
        for name, pixels in frame.aovs.items():
            if not self.is_preview:
                write_pass(result, name, pixels)
        self.end_result(result)

    def frame(self, depsgraph, width, height):
        scene, chosen = depsgraph.scene, depsgraph.scene.pellucid
        export = Export(depsgraph)
        camera = scene.camera.evaluated_get(depsgraph) if scene.camera else None
        if camera is None:
            raise pellucid.Error("the scene has no camera")
        renderer = pellucid.Renderer()
        renderer.set_scene(export.scene)
        renderer.set_environment(export.environment)
        renderer.set_camera(camera_of(camera.matrix_world, camera.calc_matrix_camera(depsgraph, x=width, y=height),
                                      camera.data.clip_start, camera.data.clip_end, export.warn))
        samples = 4 if self.is_preview else chosen.samples
        frame = renderer.render(width, height, chosen.technique_name(), samples=samples, light=chosen.light,
                                aovs=[] if self.is_preview else chosen.pass_names(), progress=self.progress)
        return frame, export.warnings + export.scene.warnings + frame.warnings

    def progress(self, share):
        self.update_progress(share)
        if self.test_break():
            raise Cancelled

    # --- viewport -------------------------------------------------------------------------------------

    def view_update(self, context, depsgraph):
        self.view = View(Export(depsgraph), depsgraph.scene.pellucid)
        self.tag_redraw()

    def view_draw(self, context, depsgraph):
        view = getattr(self, "view", None)
        if view is None:
            return
        region, data = context.region, context.region_data
        try:
            view.draw(region.width, region.height, data.view_matrix, data.window_matrix, context.space_data)
        except (pellucid.Error, pellucid.DeviceError) as error:
            self.update_stats("Pellucid", str(error))
            return
        gpu.state.blend_set("NONE")
        self.bind_display_space_shader(depsgraph.scene)
        draw_texture_2d(view.texture, (0, 0), region.width, region.height)
        self.unbind_display_space_shader()
        self.update_stats("Pellucid", f"{view.samples} of {view.most} samples {'; '.join(view.warnings[:1])}")
        if view.samples < view.most:
            self.tag_redraw()


class View:
    """One picture of the viewport, which gains a sample at every draw."""

    shown = weakref.WeakSet()

    def __init__(self, export, chosen):
        self.renderer = pellucid.Renderer()
        self.renderer.set_scene(export.scene)
        self.renderer.set_environment(export.environment)
        self.warnings = export.warnings + export.scene.warnings
        self.technique, self.light, self.most = chosen.technique_name(), chosen.light, chosen.viewport_samples
        self.key, self.samples = None, 0
        View.shown.add(self)

    def draw(self, width, height, view_matrix, window_matrix, space):
        key = (width, height, tuple(map(tuple, view_matrix)), tuple(map(tuple, window_matrix)))
        if key != self.key:
            self.key, self.samples = key, 0
            self.renderer.set_camera(camera_of(view_matrix.inverted(), window_matrix, space.clip_start, space.clip_end,
                                               lambda warning: None))
        if self.samples >= self.most:
            return
        frame = self.renderer.render(width, height, self.technique, first_sample=self.samples, light=self.light)
        share = 1.0 / (self.samples + 1)
        self.mean = frame.radiance if self.samples == 0 else self.mean + (frame.radiance - self.mean) * share
        self.samples += 1
        pixels = np.ascontiguousarray(with_alpha(self.mean)[::-1], dtype=np.float32)
        buffer = gpu.types.Buffer("FLOAT", width * height * 4, pixels.ravel())
        self.texture = gpu.types.GPUTexture((width, height), format="RGBA16F", data=buffer)


def channels_of(name, count):
    if name in LIGHT_PASSES:
        return 3, "RGB", "COLOR"
    return count, *CHANNELS[count]


def with_alpha(radiance):
    return np.concatenate([radiance, np.ones((*radiance.shape[:2], 1), dtype=np.float32)], axis=2)


def write_pass(result, name, pixels):
    """Blender's rows begin at the bottom."""
    target = next((each for each in result.layers[0].passes if each.name == name), None)
    if target is None:
        return
    rows = np.ascontiguousarray(pixels[::-1], dtype=np.float32)
    target.rect.foreach_set(rows.reshape(-1, target.channels))
