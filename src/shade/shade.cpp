#include "shade/shade.h"
#include "shade/shaders.h"

#include <array>
#include <utility>

namespace pellucid {
namespace {

constexpr auto kRadianceFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr auto kThinFormat = vk::Format::eR16G16B16A16Sfloat;  // 32-bit float targets need not blend

Program::Graphics surface_program(ShaderCode fragment, std::vector<vk::Format> colors, Blend blend, bool depth) {
    return {.vertex = shaders::surface_vert,
            .fragment = fragment,
            .colors = std::move(colors),
            .depth = depth,
            .blend = blend};
}

void merge_background(Recorder& recorder, const Frame& frame, const Opaque& opaque) {
    if (frame.background_depth == nullptr) return;
    recorder.compute(
        frame.workspace.compute(shaders::merge_background_comp, {{"kBackground", true}}),
        {frame.bindings(), writes("opaque_radiance", opaque.radiance), updates("opaque_depth", opaque.depth),
         writes("opaque_object", opaque.object), writes("opaque_triangle", opaque.triangle)},
        frame.extent);
}

}  // namespace

const GpuImage& import_depth(Recorder& recorder, const Frame& frame, const Buffer& stored,
                             const CallersDepths& meaning) {
    const GpuImage& depth = frame.workspace.image("background depth", vk::Format::eR32Sfloat, frame.extent);
    const Recorder::Scope scope(recorder, "background");
    recorder.compute(frame.workspace.compute(shaders::import_background_comp),
                     {frame.bindings(), reads("CallersDepth", stored), writes("background_depth", depth)}, meaning,
                     frame.extent);
    return depth;
}

Opaque draw_opaque(Recorder& recorder, const Frame& frame) {
    Workspace& workspace = frame.workspace;
    const Program& program = workspace.graphics(surface_program(
        frame.scene.finished ? shaders::finished_opaque_frag : shaders::opaque_frag,
        {kRadianceFormat, vk::Format::eR32Sfloat, vk::Format::eR32Uint, vk::Format::eR32Uint}, Blend::kReplace, true));
    const GpuImage& radiance = workspace.image("opaque radiance", kRadianceFormat, frame.extent);
    const GpuImage& depth = workspace.image("opaque depth", vk::Format::eR32Sfloat, frame.extent);
    const GpuImage& object = workspace.image("opaque object", vk::Format::eR32Uint, frame.extent);
    const GpuImage& triangle = workspace.image("opaque triangle", vk::Format::eR32Uint, frame.extent);
    const GpuImage& nearest = workspace.image("opaque depth test", vk::Format::eD32Sfloat, frame.extent);

    const Recorder::Scope scope(recorder, "opaque");
    const Opaque opaque{radiance, depth, object, triangle};
    if (frame.scene.opaque.empty()) {
        recorder.clear(depth, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
        if (frame.background_depth != nullptr)
            recorder.clear(triangle, vk::ClearColorValue(std::array<std::uint32_t, 4>{PELLUCID_NO_TRIANGLE, 0, 0, 0}));
        merge_background(recorder, frame, opaque);
        return opaque;
    }
    const RenderTarget target{.extent = frame.extent,
                              .colors = {{&radiance, 0, clear_to(0.0f)},
                                         {&depth, 0, clear_to(float(PELLUCID_EMPTY_DEPTH))},
                                         {&object, 0, clear_to({0u, 0u, 0u, 0u})},
                                         {&triangle, 0, clear_to({PELLUCID_NO_TRIANGLE, 0u, 0u, 0u})}},
                              .depth = RenderTarget::Attachment{&nearest, 0, clear_to_farthest()}};
    recorder.draw(program, {frame.bindings()}, target, frame.scene.opaque);
    merge_background(recorder, frame, opaque);
    return opaque;
}

ThinWalls draw_thin_walls(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers) {
    Workspace& workspace = frame.workspace;
    const Program& tint =
        workspace.graphics(surface_program(shaders::thin_tint_frag, {kThinFormat}, Blend::kMultiply, false));
    const Program& reflection =
        workspace.graphics(surface_program(shaders::thin_reflection_frag, {kThinFormat}, Blend::kAdd, false));
    // What nothing in the scene draws into is not looked at either.
    const auto look_image = [&](std::string_view name) -> const GpuImage& {
        return workspace.image(name, kThinFormat, frame.scene.thin_walled.empty() ? vk::Extent2D{1, 1} : frame.extent);
    };
    const GpuImage& thin_tint = look_image("thin tint");
    const GpuImage& thin_reflection = look_image("thin reflection");
    const auto target = [&](const GpuImage& image, float clear) {
        return RenderTarget{.extent = frame.extent, .colors = {{&image, 0, clear_to(clear)}}};
    };
    const GpuScene& scene = frame.scene;

    const Recorder::Scope scope(recorder, "surface look");
    if (scene.thin_walled.empty()) return {thin_tint, thin_reflection};
    recorder.draw(tint, {frame.bindings(), reads("opaque_depth", opaque.depth), reads("layer_depth", layers.depth)},
                  target(thin_tint, 1.0f), scene.thin_walled);
    recorder.draw(reflection,
                  {frame.bindings(), reads("opaque_depth", opaque.depth), reads("layer_depth", layers.depth)},
                  target(thin_reflection, 0.0f), scene.thin_walled);
    return {thin_tint, thin_reflection};
}

const GpuImage& shade(Recorder& recorder, const Frame& frame, const Opaque& opaque, const Layers& layers,
                      const ThinWalls& walls, const Refraction& refraction, View view) {
    Workspace& workspace = frame.workspace;
    const GpuImage& radiance = workspace.image("radiance", kRadianceFormat, frame.extent);
    const std::array constants = {Constant{"kEnvironmentKind", frame.environment_kind},
                                  Constant{"kAnalysis", view == View::kAnalysis},
                                  Constant{"kThinWalls", !frame.scene.thin_walled.empty()},
                                  Constant{"kOpaque", frame.has_opaque()},
                                  Constant{"kBackground", frame.background_depth != nullptr},
                                  Constant{"kTextured", frame.scene.textured_glass},
                                  Constant{"kPathRadiance", refraction.radiance != nullptr},
                                  Constant{"kReflected", refraction.reflected != nullptr},
                                  Constant{"kHighlights", refraction.reflects_lights_alone},
                                  Constant{"kFootprint", refraction.footprint},
                                  Constant{"kVisibleLights", frame.light.visible_lights()}};
    // Something of the right kind has to be bound where paths pick up nothing.
    const GpuImage& path_radiance =
        refraction.radiance ? *refraction.radiance : workspace.image("no radiance", kRadianceFormat, {1, 1});

    const GpuImage& reflected = refraction.reflected ? *refraction.reflected : path_radiance;

    const Recorder::Scope scope(recorder, "shade");
    recorder.compute(
        workspace.compute(shaders::background_comp, constants),
        {frame.bindings(), reads("thin_tint", walls.thin_tint), reads("thin_reflection", walls.thin_reflection),
         reads("opaque_radiance", opaque.radiance), reads("opaque_depth", opaque.depth), writes("radiance", radiance)},
        frame.extent);
    recorder.compute_indirect(
        workspace.compute(shaders::shade_comp, constants),
        {frame.bindings(), layers.bindings(), refraction.bindings(), reads("thin_tint", walls.thin_tint),
         reads("thin_reflection", walls.thin_reflection), reads("path_radiance", path_radiance),
         reads("reflected_radiance", reflected), writes("radiance", radiance)},
        layers.covered);
    if (refraction.picture) {
        recorder.compute(workspace.compute(shaders::compose_picture_comp, constants),
                         {reads("picture", *refraction.picture), reads("reflected_radiance", reflected),
                          reads("path_events", refraction.events), writes("radiance", radiance)},
                         frame.extent);
    }
    return radiance;
}

void count_events(Recorder& recorder, const Frame& frame, const Refraction& refraction,
                  std::function<void(const EventCounts&)> then) {
    const Buffer& counts = frame.workspace.buffer("counts of events", sizeof(EventCounts));
    recorder.fill(counts, 0);
    recorder.compute(frame.workspace.compute(shaders::count_events_comp),
                     {reads("path_events", refraction.events), updates("EventCounts", counts)}, frame.extent);
    recorder.read<EventCounts>(counts, 0, std::move(then));
}

const GpuImage& accumulate(Recorder& recorder, const Frame& frame, const GpuImage& radiance, std::uint32_t sample,
                           const GpuImage* wanted, std::string_view name) {
    const GpuImage& sum = frame.workspace.image(name, kRadianceFormat, frame.extent);
    const Recorder::Scope scope(recorder, "accumulate");
    if (wanted != nullptr)
        recorder.compute(frame.workspace.compute(shaders::accumulate_wanted_comp),
                         {reads("radiance", radiance), updates("radiance_sum", sum), reads("wanted_samples", *wanted)},
                         sample, frame.extent);
    else
        recorder.compute(frame.workspace.compute(shaders::accumulate_comp),
                         {reads("radiance", radiance), updates("radiance_sum", sum)}, sample, frame.extent);
    return sum;
}

const GpuImage& tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale, ToneMap curve,
                        bool swap_red_blue) {
    struct Push {
        float scale;
        std::uint32_t curve;
    };
    const GpuImage& display = frame.workspace.image("display", vk::Format::eR8G8B8A8Unorm, frame.extent);
    const Recorder::Scope scope(recorder, "tonemap");
    recorder.compute(frame.workspace.compute(shaders::tonemap_comp, {{"kSwapRedBlue", swap_red_blue}}),
                     {reads("radiance", radiance), writes("display", display)}, Push{scale, std::uint32_t(curve)},
                     frame.extent);
    return display;
}

const GpuImage& scale_radiance(Recorder& recorder, const Frame& frame, const GpuImage& radiance, float scale) {
    const GpuImage& scaled = frame.workspace.image("scaled radiance", kRadianceFormat, frame.extent);
    const Recorder::Scope scope(recorder, "scale");
    recorder.compute(frame.workspace.compute(shaders::scale_radiance_comp),
                     {reads("radiance", radiance), writes("scaled", scaled)}, scale, frame.extent);
    return scaled;
}

}  // namespace pellucid
