// The paths of visibility-layers, in maps of the meshes instead of a map of the view.
#include "techniques/visibility_cube/visibility_cube.h"

#include "techniques/visibility_layers/visibility_layers.h"

#include <algorithm>
#include <array>

namespace pellucid {
namespace {

constexpr ParameterInfo kResolution{
    "resolution", "", kMeshMapResolution, 2, 8192, true, "texels of a mesh's maps along the longest side of its box"};

constexpr auto kParameters = [] {
    std::array<ParameterInfo, kPathParameters.size() + 1> all{kResolution};
    std::copy(kPathParameters.begin(), kPathParameters.end(), all.begin() + 1);
    return all;
}();

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const SurfaceMap map = layers.source.map_meshes(recorder, frame, parameters.whole("resolution"));
    return follow_paths(recorder, frame, layers, map, parameters);
}

}  // namespace

constexpr Technique kVisibilityCube{
    .info = {.name = "visibility-cube",
             .summary =
                 "every interface, found in lists of triangles per texel that are kept for each mesh in its own frame",
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
