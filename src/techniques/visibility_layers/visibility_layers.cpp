#include "techniques/visibility_layers/visibility_layers.h"

#include "light/photon_store.h"
#include "techniques/shaders.h"

namespace pellucid {
namespace {

constexpr std::uint32_t kEventsOfLight = 16;  ///< surfaces that a path from an opaque surface meets at most
constexpr float kThresholdOfLight = 0.01f;    ///< what a bounce carries at least

Ways ways_of(const ParameterValues& parameters, std::uint32_t most_branches, bool volumes) {
    if (parameters.whole("one-branch") != 0) return Ways::kStochastic;
    return most_branches > 0 || volumes ? Ways::kTree : Ways::kTransmitted;
}

/// Lets opaque surfaces at which paths end look to what lights them. Technique ihrke-2007 has light of its own.
void light_surfaces(PathTask& task, const Frame& frame) {
    const bool scatters = !frame.scene.opaque.empty() || (frame.scene.rough_glass && frame.light.lights > 0);
    task.lights_surfaces = frame.light.any() && scatters && task.volumes == nullptr;
    // Where reflections are followed, opaque surfaces behind glass are seen beside each other.
    const std::uint32_t least_bounces = task.ways == Ways::kTree ? 1 : 0;
    task.push.most_bounces = std::max(task.lights_surfaces ? frame.light.bounces : 0, least_bounces);
    if (!task.lights_surfaces) return;
    task.full_light = frame.light.bounces > 0;
    task.push.direct_lights = frame.light.lights;
    task.push.emitter_count = frame.light.emitters;
    task.push.tinted_shadows = frame.light.tinted_shadows ? 1 : 0;
}

/// View rays, which start at the eye where what they meet first cannot be told from the first layer.
PathTask view_task(const Frame& frame, const ParameterValues& parameters, const PathVolumes* volumes,
                   const SurfaceFinder& finder) {
    const SceneTopology& topology = *frame.scene.topology;
    const double given = parameters["branches"];
    PathTask task{.end = volumes != nullptr ? volumes->end_shader() : shaders::end_paths_comp, .volumes = volumes};
    PathPush& push = task.push;
    push.max_events = parameters.whole("events");
    push.most_branches = given >= 0.0 ? std::uint32_t(given) : frame.samples > 1 ? 16 : 0;
    push.threshold = float(parameters["threshold"]);
    push.whole_picture = volumes != nullptr || topology.eye_in_solid || topology.eye_differs ? 1 : 0;
    push.eye_differs = topology.eye_differs ? 1 : 0;
    push.eye_depth = topology.eye_depth;
    task.ways = ways_of(parameters, push.most_branches, volumes != nullptr);
    if (task.ways == Ways::kStochastic) push.most_branches = 0;
    light_surfaces(task, frame);
    task.ends_together =
        task.ways != Ways::kTree && !task.lights_surfaces && frame.scene.opaque.empty() && volumes == nullptr;
    const bool at_eye = push.whole_picture != 0 || !topology.all_alone;
    if (task.lights_surfaces && push.whole_picture == 0 && !frame.scene.opaque.empty())
        task.begin_at_end = shaders::begin_on_opaque_comp;
    task.begin = !at_eye                       ? shaders::begin_paths_comp
                 : finder.hierarchy != nullptr ? shaders::begin_traced_at_eye_comp
                                               : shaders::begin_at_eye_comp;
    if (finder.host == nullptr) task.surfaces_per_pass = parameters.whole("surfaces-per-pass");
    return task;
}

/// What the ends of paths bind besides what they write: caches of light, or what stands for them.
std::vector<Binding> light_bindings(const Frame& frame) {
    constexpr vk::DeviceSize kLeast = 96;  // a grid and a node
    std::vector<Binding> bindings = photon_bindings(frame);
    const Buffer& none = frame.workspace.buffer("no irradiance", kLeast);
    bindings.push_back(reads("EnvironmentShares", frame.environment_shares ? *frame.environment_shares : none));
    if (frame.irradiance == nullptr)
        bindings.push_back(reads("IrradianceNodes", none));
    else
        bindings.insert(bindings.end(), frame.irradiance->begin(), frame.irradiance->end());
    return bindings;
}

std::vector<Binding> view_bindings(const Frame& frame, const Layers& layers, const Refraction& refraction,
                                   const GpuImage& reflected) {
    std::vector<Binding> bindings = light_bindings(frame);
    bindings.insert(bindings.end(),
                    {layers.bindings(), refraction.bindings(),
                     updates("IrradiancePoints", frame.workspace.buffer("no points of irradiance", 16)),
                     updates("path_radiance", *refraction.radiance), updates("reflected_radiance", reflected),
                     updates("surface_radiance", layers.opaque.radiance)});
    return bindings;
}

Refraction follow_view_rays(Recorder& recorder, const Frame& frame, const Layers& layers, const SurfaceFinder& finder,
                            const ParameterValues& parameters, const PathVolumes* volumes = nullptr) {
    const Recorder::Scope scope(recorder, "trace");
    Refraction refraction = clear_refraction(recorder, frame, true);
    const GpuImage& reflected =
        frame.workspace.image("reflected radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    PathTask task = view_task(frame, parameters, volumes, finder);
    if (task.begin.name == shaders::begin_paths_comp.name) task.beginning = &layers.covered;
    task.bindings = view_bindings(frame, layers, refraction, reflected);
    follow(recorder, frame, layers.source, finder, task);
    refraction.reflects_lights_alone =
        task.ways == Ways::kTransmitted && task.push.whole_picture == 0 && task.looks_from_glass(frame.scene);
    if (task.ways != Ways::kTransmitted || task.push.whole_picture != 0 || refraction.reflects_lights_alone)
        refraction.reflected = &reflected;
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
     "paths that the view's map loses, as beyond the edge of the view, are finished by maps of the meshes", kOffOn});

}  // namespace

void prepare_paths(const Preparation& preparation, const ParameterValues&) {
    preparation.gpu_scene.prepare_topology(preparation.device, preparation.scene);
}

HostFinder& host_finder_of(const Preparation& preparation) {
    GpuScene& scene = preparation.gpu_scene;
    if (!scene.host_finder) scene.host_finder = std::make_unique<HostFinder>(preparation.threads);
    return static_cast<HostFinder&>(*scene.host_finder);
}

void prepare_light(const Preparation& preparation) {
    GpuScene& scene = preparation.gpu_scene;
    scene.prepare_topology(preparation.device, preparation.scene);
    if (preparation.device.is_cpu() && !preparation.recorded)
        host_finder_of(preparation).bring_up_to_date(preparation.device, preparation.scene, scene);
}

void light_surfaces(Recorder& recorder, const Frame& frame, const Layers& layers) {
    const Recorder::Scope scope(recorder, "light");
    const SurfaceFinder finder = SurfaceFinder::of_device(recorder, frame, layers.source);
    PathTask task{.end = shaders::end_paths_comp, .begin_at_end = shaders::begin_on_opaque_comp};
    light_surfaces(task, frame);
    task.push.max_events = kEventsOfLight;
    task.push.threshold = kThresholdOfLight;
    task.push.behind_glass = 1;
    // Nothing is seen through glass here, but all that end_paths.comp writes has to be bound.
    const Refraction refraction = allocate_refraction(frame, true);
    const GpuImage& reflected =
        frame.workspace.image("reflected radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    task.bindings = view_bindings(frame, layers, refraction, reflected);
    follow(recorder, frame, layers.source, finder, task);
}

Gathered gather_irradiance(Recorder& recorder, const Frame& frame, LayerSource& source, const Buffer& points) {
    const SceneTopology& topology = *frame.scene.topology;
    const SurfaceFinder finder = SurfaceFinder::of_device(recorder, frame, source);
    PathTask task{.begin = shaders::begin_gather_comp,
                  .end = shaders::end_paths_comp,
                  .gathers = true,
                  .ways = Ways::kStochastic};
    light_surfaces(task, frame);
    task.push.max_events = kEventsOfLight;
    task.push.threshold = kThresholdOfLight;
    task.push.whole_picture = 1;
    task.push.eye_differs = topology.eye_differs ? 1 : 0;
    task.push.eye_depth = topology.eye_depth;
    const Refraction refraction = allocate_refraction(frame, true);
    const GpuImage& sky = frame.workspace.image("reflected radiance", vk::Format::eR32G32B32A32Sfloat, frame.extent);
    task.bindings = light_bindings(frame);
    task.bindings.insert(task.bindings.end(), {refraction.bindings(), updates("path_radiance", *refraction.radiance),
                                               updates("reflected_radiance", sky), updates("surface_radiance", sky),
                                               updates("IrradiancePoints", points)});
    follow(recorder, frame, source, finder, task);
    return {*refraction.radiance, sky};
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
