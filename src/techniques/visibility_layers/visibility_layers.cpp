#include "techniques/visibility_layers/visibility_layers.h"

#include "layers/pixel_list.h"

#include <array>

namespace pellucid {
namespace {

constexpr std::uint32_t kBeginPaths[] = {
#include "begin_paths.comp.inc"
};
constexpr std::uint32_t kFollowPaths[] = {
#include "follow_paths.comp.inc"
};

constexpr std::array kParameters = {
    ParameterInfo{"layers", "", 8, 1, 4095, true, "unused yet"},
    ParameterInfo{"events", "", 16, 1, 4095, true, "refractions and reflections followed"},
};

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const SurfaceMap& map = layers.source.view_map();
    const SceneTopology& topology = *frame.scene.topology;
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame);
    Workspace& workspace = frame.workspace;
    const std::uint64_t pixels = std::uint64_t(frame.extent.width) * frame.extent.height;
    const Buffer& places = workspace.buffer("path places", pixels * 16);
    const Buffer& ways = workspace.buffer("path ways", pixels * 16);
    const Buffer& weights = workspace.buffer("path weights", pixels * 16);
    const std::uint32_t words = std::max((topology.solids + 7) / 8, 1u);
    const Buffer& media = workspace.buffer("path media", pixels * 4 * words);
    const Buffer* next = &start_pixel_list(recorder, frame, "paths 0");
    recorder.compute_indirect(
        workspace.compute({"begin_paths.comp", kBeginPaths}, {words}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
         reads("Materials", frame.scene.materials), reads("Indices", frame.scene.indices),
         reads("Vertices", frame.scene.vertices), reads("Traits", topology.traits), reads("Solids", topology.materials),
         reads("layer_triangle", layers.triangle), reads("PixelList", layers.covered), updates("NextList", *next),
         updates("PathPlaces", places), updates("PathWays", ways), updates("PathWeights", weights),
         updates("PathMedia", media)},
        layers.covered);
    struct Push {
        std::uint32_t last;
        float t_min;
    };
    const float rounding = 1e-6f * (glm::length(frame.scene.bounds.center) + frame.scene.bounds.radius);
    const std::uint32_t events = parameters.whole("events");
    for (std::uint32_t event = 1; event <= events; ++event) {
        const Buffer& list = *next;
        next = &start_pixel_list(recorder, frame, event % 2 == 0 ? "paths 0" : "paths 1");
        recorder.compute_indirect(
            workspace.compute({"follow_paths.comp", kFollowPaths}, {words}),
            {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
             reads("Materials", frame.scene.materials), reads("Indices", frame.scene.indices),
             reads("Vertices", frame.scene.vertices), reads("Traits", topology.traits),
             reads("Solids", topology.materials), reads("PixelList", list), updates("NextList", *next),
             updates("PathPlaces", places), updates("PathWays", ways), updates("PathWeights", weights),
             updates("PathMedia", media), reads("Maps", *map.maps), reads("MapTriangles", *map.triangles),
             reads("Texels", *map.texels), reads("Records", *map.records), reads("Pyramid", *map.pyramid),
             writes("exit_direction", refraction.exit_direction), writes("exit_position", refraction.exit_position),
             writes("transmittance", refraction.transmittance), writes("path_events", refraction.events)},
            Push{event == events ? 1u : 0u, -rounding}, list);
    }
    return refraction;
}

}  // namespace

constexpr Technique kVisibilityLayers{
    .info = {.name = "visibility-layers",
             .summary = "every interface, found in lists of triangles per texel that are made anew in every frame",
             .source = {},
             .parameters = kParameters,
             .many_media = true},
    .layer_count = [](const ParameterValues&) { return 1u; },
    .walks_map = true,
    .record = record,
};

}  // namespace pellucid
