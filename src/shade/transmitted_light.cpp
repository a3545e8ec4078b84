// Chen, "Real-time transmission of translucent objects by depth peeling": thickness from layers peeled from the light,
// in the same frame.
#include "shade/transmitted_light.h"

#include "gpu/punctual_light.h"

#include "layers/pixel_list.h"
#include "shade/shaders.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace pellucid {
namespace {

constexpr auto kTranslucentFormat = vk::Format::eR16G16B16A16Sfloat;

/// Value of kMethod in transmit_light.comp.
std::uint32_t method_constant(ThicknessMethod method) {
    switch (method) {
        case ThicknessMethod::kTranslucentShadowMap:
            return 1;
        case ThicknessMethod::kLocalThickness:
        case ThicknessMethod::kPublishedLocalThickness:
            return 2;
        case ThicknessMethod::kPublishedShadowMap:
        case ThicknessMethod::kPublishedDepthPeeling:
            return 3;
        case ThicknessMethod::kDepthPeeling:
        case ThicknessMethod::kDualDepthPeeling:
        case ThicknessMethod::kLayers:
            break;
    }
    return 0;
}

}  // namespace

/// The nearest opaque surfaces, where they are translucent. `pixels` lists their pixels.
struct TransmittedLight::Surfaces {
    const GpuImage &triangle, &normal, &reflected, &transmitted;
    const Buffer& pixels;
};

void TransmittedLight::begin(TransmittedLightSetup setup) {
    workspace_.trim();
    cut_rays_ = 0;
    any_ = false;
    const bool same_maps = setup.resolution == setup_.resolution && setup.layers == setup_.layers &&
                           setup.views.size() == setup_.views.size();
    if (!same_maps) source_ = LayerSource();
    setup_ = std::move(setup);
}

void TransmittedLight::forget() { source_ = LayerSource(); }

Frame TransmittedLight::light_frame(const Frame& frame, const Buffer& constants,
                                    const gpu::FrameConstants& view) const {
    return seen_from(frame, workspace_, constants, view, {setup_.resolution, setup_.resolution});
}

TransmittedLight::Surfaces TransmittedLight::draw_surfaces(Recorder& recorder, const Frame& frame,
                                                           const Opaque& opaque) {
    Workspace& workspace = frame.workspace;
    const GpuScene& scene = frame.scene;
    const Program& program = workspace.graphics(
        {.vertex = shaders::surface_vert,
         .fragment = shaders::translucent_surface_frag,
         .colors = {kTranslucentFormat, kTranslucentFormat, vk::Format::eR32Uint, vk::Format::eR32Uint},
         .depth = true});
    const GpuImage& reflected = workspace.image("translucent reflected", kTranslucentFormat, frame.extent);
    const GpuImage& transmitted = workspace.image("translucent transmitted", kTranslucentFormat, frame.extent);
    const GpuImage& triangle = workspace.image("translucent triangle", vk::Format::eR32Uint, frame.extent);
    const GpuImage& normal = workspace.image("translucent normal", vk::Format::eR32Uint, frame.extent);
    const GpuImage& nearest = workspace.image("translucent depth test", vk::Format::eD32Sfloat, frame.extent);
    const Recorder::Scope scope(recorder, "translucent surfaces");
    const RenderTarget target{.extent = frame.extent,
                              .colors = {{&reflected, 0, clear_to(0.0f)},
                                         {&transmitted, 0, clear_to(0.0f)},
                                         {&triangle, 0, clear_to({PELLUCID_NO_TRIANGLE, 0u, 0u, 0u})},
                                         {&normal, 0, clear_to({0u, 0u, 0u, 0u})}},
                              .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()}};
    recorder.draw(program, {frame.bindings(), reads("opaque_depth", opaque.depth)}, target, scene.translucent);
    const Buffer& pixels =
        list_pixels(recorder, frame, triangle, PELLUCID_NO_TRIANGLE, "translucent pixels", 0, frame.extent.height);
    return {triangle, normal, reflected, transmitted, pixels};
}

Frame TransmittedLight::view_from(Recorder& recorder, const Frame& frame, std::size_t number) {
    gpu::FrameConstants values = setup_.views[number].constants;
    values.object_count = frame.scene.object_count;
    const Buffer& constants = workspace_.buffer(fmt::format("light constants {}", number), sizeof(values));
    recorder.write(constants, values);
    return light_frame(frame, constants, values);
}

const GpuImage& TransmittedLight::build_map(Recorder& recorder, const Frame& frame, const Opaque& opaque,
                                            std::size_t number) {
    const Frame from_light = view_from(recorder, frame, number);
    return source_.build(recorder, from_light, opaque, {frame.scene.opaque, layer_count(), false, "light"}).triangle;
}

void TransmittedLight::build_maps(Recorder& recorder, const Frame& frame, const Opaque& opaque) {
    if (!any_ || !needs_layers()) return;
    source_.begin_frame(setup_.builder);
    for (std::size_t view = 0; view < setup_.views.size(); ++view) build_map(recorder, frame, opaque, view);
}

void TransmittedLight::record_view(Recorder& recorder, const Frame& frame, const Opaque& opaque,
                                   const Surfaces& surfaces, const GpuImage& thickness, std::size_t number,
                                   bool measures) {
    const LightView& view = setup_.views[number];
    const GpuScene& scene = frame.scene;
    const Frame from_light = view_from(recorder, frame, number);
    const GpuImage& triangles = needs_layers() ? build_map(recorder, frame, opaque, number)
                                               : workspace_.image("no layers", vk::Format::eR32Uint, {1, 1});
    // Every binding needs a buffer, even if nothing is baked.
    const Buffer& nothing = workspace_.buffer("nothing baked", 16);
    struct Push {
        PunctualLight light;
        std::uint32_t face, layer_count;
    };
    const Recorder::Scope scope(recorder, "transmitted light");
    recorder.compute_indirect(
        frame.workspace.compute(shaders::transmit_light_comp,
                                {{"kMethod", method_constant(setup_.method)},
                                 {"kMeasures", measures},
                                 {"kOneObject", scene.opaque.size() == 1 && scene.object_count == 1}}),
        {frame.bindings(), reads("LightFrame", from_light.constants), reads("surface_triangle", surfaces.triangle),
         reads("surface_normals", surfaces.normal), reads("surface_reflected", surfaces.reflected),
         reads("surface_transmitted", surfaces.transmitted), reads("layer_triangle", triangles),
         reads("LocalThickness", setup_.local ? setup_.local->values : nothing),
         reads("LocalObjects", setup_.local ? setup_.local->objects : nothing), updates("radiance", opaque.radiance),
         writes("thickness", thickness), updates("LightCounters", workspace_.buffer("light counters", 4)),
         reads("PixelList", surfaces.pixels)},
        Push{punctual_light(setup_.lights.at(view.light)), view.face, layer_count()}, surfaces.pixels);
}

void TransmittedLight::record(Recorder& recorder, const Frame& frame, const Opaque& opaque, const GpuImage& thickness,
                              bool measures) {
    any_ = !setup_.views.empty() && !frame.scene.translucent.empty();
    if (!any_) return;
    source_.begin_frame(setup_.builder);
    const Surfaces surfaces = draw_surfaces(recorder, frame, opaque);
    const Buffer& counters = workspace_.buffer("light counters", 4);
    recorder.fill(counters, 0);
    for (std::size_t view = 0; view < setup_.views.size(); ++view)
        record_view(recorder, frame, opaque, surfaces, thickness, view, measures);
    recorder.read<std::uint32_t>(counters, 0, [this](std::uint32_t rays) { cut_rays_ = rays; });
}

void TransmittedLight::add(Recorder& recorder, const Frame& frame, const Opaque& opaque) {
    record(recorder, frame, opaque, workspace_.image("no thickness", vk::Format::eR32Sfloat, {1, 1}), false);
}

const GpuImage& TransmittedLight::measure(Recorder& recorder, const Frame& frame, const Opaque& opaque) {
    const GpuImage& thickness = frame.workspace.image("thickness", vk::Format::eR32Sfloat, frame.extent);
    recorder.clear(thickness, vk::ClearColorValue(std::array{kNotTranslucent, 0.0f, 0.0f, 0.0f}));
    record(recorder, frame, opaque, thickness, true);
    return thickness;
}

bool TransmittedLight::must_repeat(const Frame& frame) {
    if (!any_ || !needs_layers()) return false;
    return source_.must_repeat(light_frame(frame, frame.constants, frame.view));
}

}  // namespace pellucid
