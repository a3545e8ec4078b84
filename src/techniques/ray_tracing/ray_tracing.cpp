// The paths of visibility-layers, whose surfaces the device's ray tracing finds.
#include "techniques/ray_tracing/ray_tracing.h"
#include "techniques/shaders.h"

#include "techniques/visibility_layers/visibility_layers.h"

namespace pellucid {
namespace {

constexpr NamedValue kRebuild[] = {{0, "kept", "and refitted where vertices have moved"},
                                   {1, "refitted", "in every frame, to measure that"},
                                   {2, "built", "in every frame, to measure that"}};

constexpr auto kParameters =
    path_parameters_and({"rebuild", "", 0, 0, 2, true, "what becomes of the hierarchy", kRebuild});

/// Vertices that have moved once are likely to move again.
StructureUse structure_use(std::uint32_t rebuild, bool moved) {
    if (rebuild == 2) return StructureUse::kRebuild;
    return rebuild == 1 || moved ? StructureUse::kRefit : StructureUse::kStatic;
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const std::uint32_t rebuild = parameters.whole("rebuild");
    SceneHierarchy& hierarchy = frame.workspace.hierarchy(frame.scene, structure_use(rebuild, frame.scene.moves > 0));
    hierarchy.update(recorder, frame.scene, rebuild != 0);
    return follow_paths(recorder, frame, layers, hierarchy, parameters);
}

constexpr std::initializer_list<const ShaderCode*> kPrograms = {
    &shaders::begin_paths_comp, &shaders::begin_traced_at_eye_comp, &shaders::follow_traced_paths_comp,
    &shaders::begin_on_opaque_comp, &shaders::end_paths_comp};

}  // namespace

constexpr Technique kRayTracing{
    .info = {.name = "ray-tracing",
             .summary = "every interface, found by the device's ray tracing, on devices with ray queries",
             .source = {},
             .parameters = kParameters,
             .many_media = true,
             .whole_scene = true},
    .programs = kPrograms,
    .lacking = [](const Device& device) -> std::string {
        return device.ray_tracing() ? "" : "VK_KHR_ray_query and VK_KHR_acceleration_structure";
    },
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers"); },
    .prepare = prepare_paths,
    .record = record,
};

}  // namespace pellucid
