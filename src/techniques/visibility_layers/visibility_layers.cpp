#include "techniques/visibility_layers/visibility_layers.h"

#include "techniques/shaders.h"

namespace pellucid {
namespace {

Ways ways_of(const ParameterValues& parameters, std::uint32_t most_branches, bool volumes) {
    if (parameters.whole("one-branch") != 0) return Ways::kStochastic;
    return most_branches > 0 || volumes ? Ways::kTree : Ways::kTransmitted;
}

/// View rays, which start at the eye where what they meet first cannot be told from the first layer.
PathTask view_task(const Frame& frame, const ParameterValues& parameters, const PathVolumes* volumes,
                   const SurfaceFinder& finder) {
    const SceneTopology& topology = *frame.scene.topology;
    const double given = parameters["branches"];
    PathTask task;
    task.end = volumes != nullptr ? volumes->end_shader() : shaders::end_paths_comp;
    task.volumes = volumes;
    PathPush& push = task.push;
    push.max_events = parameters.whole("events");
    push.most_branches = given >= 0.0 ? std::uint32_t(given) : frame.samples > 1 ? 16 : 0;
    push.threshold = float(parameters["threshold"]);
    push.whole_picture = volumes != nullptr || topology.eye_in_solid || topology.eye_differs ? 1 : 0;
    push.eye_differs = topology.eye_differs ? 1 : 0;
    push.eye_depth = topology.eye_depth;
    task.ways = ways_of(parameters, push.most_branches, volumes != nullptr);
    if (task.ways == Ways::kStochastic) push.most_branches = 0;
    task.ends_together = task.ways != Ways::kTree && frame.scene.opaque.empty() && volumes == nullptr;
    const bool at_eye = push.whole_picture != 0 || !topology.all_alone;
    task.begin = !at_eye                       ? shaders::begin_paths_comp
                 : finder.hierarchy != nullptr ? shaders::begin_traced_at_eye_comp
                                               : shaders::begin_at_eye_comp;
    if (finder.host == nullptr) task.surfaces_per_pass = parameters.whole("surfaces-per-pass");
    return task;
}

Refraction follow_view_rays(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceFinder& finder,
                            const ParameterValues& parameters, const PathVolumes* volumes = nullptr) {
    const Recorder::Scope scope(recorder, "trace");
    Refraction refraction = clear_refraction(recorder, frame, true);
    const GpuImage& reflected =
        frame.workspace.image("reflected radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    PathTask task = view_task(frame, parameters, volumes, finder);
    if (task.begin.name == shaders::begin_paths_comp.name) task.beginning = &layers.covered;
    task.bindings = {layers.bindings(), refraction.bindings(), updates("path_radiance", *refraction.radiance),
                     updates("reflected_radiance", reflected)};
    follow(recorder, frame, layers.source, finder, task);
    if (task.ways != Ways::kTransmitted || task.push.whole_picture != 0) refraction.reflected = &reflected;
    if (task.push.whole_picture != 0) refraction.picture = refraction.radiance;
    return refraction;
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const auto map_meshes = [&] { return layers.source.map_meshes(recorder, frame, kMeshMapResolution); };
    // Paths in glass that lies partly beside the view, or around the eye, would leave a map of the view.
    if (!LayerSource::view_holds_glass(frame)) return follow_paths(recorder, frame, layers, map_meshes(), parameters);
    SurfaceFinder finder{.map = layers.source.map_view(recorder, frame)};
    finder.loses_paths = parameters["finish"] != 0.0;
    if (finder.loses_paths && layers.source.finishes_paths()) finder.finishing = map_meshes();
    return follow_view_rays(recorder, frame, layers, finder, parameters);
}

constexpr auto kParameters = path_parameters_and(
    {"finish", "", 1, 0, 1, true,
     "1: paths that the view's map loses, as beyond the edge of the view, are finished by maps of the meshes"});

}  // namespace

void prepare_paths(const Preparation& preparation, const ParameterValues&) {
    preparation.gpu_scene.prepare_topology(preparation.device, preparation.scene);
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceMap& map,
                        const ParameterValues& parameters, const PathVolumes* volumes) {
    return follow_view_rays(recorder, frame, layers, {.map = map}, parameters, volumes);
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const HostFinder& finder,
                        const ParameterValues& parameters) {
    return follow_view_rays(recorder, frame, layers, SurfaceFinder::on_host(finder), parameters);
}

Refraction follow_paths(Recorder& recorder, const Frame& frame, const Layers& layers, const SceneHierarchy& hierarchy,
                        const ParameterValues& parameters) {
    return follow_view_rays(recorder, frame, layers, SurfaceFinder::traced(recorder, frame, hierarchy), parameters);
}

constexpr Technique kVisibilityLayers{
    .info = {.name = "visibility-layers",
             .summary = "every interface, found in lists of triangles per texel that are made anew in every frame",
             .source = {},
             .parameters = kParameters,
             .many_media = true,
             .whole_scene = true},
    .programs = kPathPrograms,
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers"); },
    .prepare = prepare_paths,
    .record = record,
};

}  // namespace pellucid
