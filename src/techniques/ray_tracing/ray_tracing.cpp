#include "techniques/ray_tracing/ray_tracing.h"
#include "techniques/shaders.h"

#include <array>

namespace pellucid {
namespace {

constexpr std::array kParameters = {
    ParameterInfo{"events", "", 16, 1, 4095, true, "refractions and reflections followed"},
    ParameterInfo{"rebuild", "", 0, 0, 2, true, "hierarchy: 0 kept, 1 refitted in every frame, 2 built in every frame"},
};

/// Twin of Push in surface_hit.glsl.
struct Push {
    std::array<std::uint32_t, 2> vertices;  // low word, high word
    std::array<std::uint32_t, 2> indices;
    std::uint32_t max_events;
};

std::array<std::uint32_t, 2> words_of(vk::DeviceAddress address) {
    return {std::uint32_t(address), std::uint32_t(address >> 32)};
}

StructureUse structure_use(std::uint32_t rebuild) {
    return std::array{StructureUse::kStatic, StructureUse::kRefit, StructureUse::kRebuild}.at(rebuild);
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    SceneHierarchy& hierarchy = frame.workspace.hierarchy(frame.scene, structure_use(parameters.whole("rebuild")));
    hierarchy.update(recorder);

    const Recorder::Scope scope(recorder, "trace");
    Refraction refraction = allocate_refraction(frame);
    refraction.everywhere = true;
    const Push push{words_of(frame.scene.vertices.address()), words_of(frame.scene.indices.address()),
                    parameters.whole("events")};
    recorder.trace(
        frame.workspace.ray_tracing({.raygen = shaders::ray_tracing_rgen,
                                     .miss = shaders::ray_tracing_rmiss,
                                     .closest_hit = shaders::ray_tracing_rchit}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
         reads("Materials", frame.scene.materials), reads("layer_depth", layers.depth),
         reads("layer_triangle", layers.triangle), reads("layer_normal", layers.normal),
         writes("exit_direction", refraction.exit_direction), writes("exit_position", refraction.exit_position),
         writes("transmittance", refraction.transmittance), writes("path_events", refraction.events),
         reads("solids", hierarchy.top())},
        push, frame.extent);
    return refraction;
}

}  // namespace

constexpr Technique kRayTracing{
    .info = {.name = "ray-tracing",
             .summary = "every interface by ray-tracing pipelines, on devices that have them",
             .source = {},
             .parameters = kParameters,
             .many_media = true},
    .lacking = [](const Device& device) -> std::string {
        return device.ray_tracing() ? "" : "VK_KHR_ray_tracing_pipeline and VK_KHR_acceleration_structure";
    },
    .layer_count = [](const ParameterValues&) { return 1u; },
    .record = record,
};

}  // namespace pellucid
