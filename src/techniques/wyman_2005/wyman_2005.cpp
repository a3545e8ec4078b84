#include "techniques/wyman_2005/wyman_2005.h"

#include "layers/back_faces.h"
#include "techniques/shaders.h"
#include "techniques/wyman_2005/baked_distances.h"

#include <array>

namespace pellucid {
namespace {

using wyman_2005::Distances;

constexpr std::array kParameters = {
    ParameterInfo{"back-face", "", 0, 0, 1, true, "far side of the glass: 0 the first back face, 1 the farthest"},
    ParameterInfo{"distances", "", 0, 0, 1, true,
                  "way through the glass: 0 between the view ray's and the normal's, 1 from a table of samples"},
    ParameterInfo{"table", "", 64, 4, 64, true,
                  "points and directions along a side of the table; it has their 4th power"},
    ParameterInfo{"nearby-steps", "", 64, 1, 4096, true, "linear steps in search of opaque objects behind the glass"},
    ParameterInfo{"nearby-binary-steps", "", 6, 0, 24, true, "binary steps after a linear one"},
};

Distances distances_of(const ParameterValues& parameters) { return Distances(parameters.whole("distances")); }

void prepare(const Preparation& preparation, const ParameterValues& parameters) {
    wyman_2005::bake(preparation, distances_of(parameters), parameters.whole("table"));
}

/// Ends paths on the opaque surfaces that the picture shows (Wyman 2005b).
void find_nearby_geometry(Recorder& recorder, const Frame& frame, const Layers& layers, const Refraction& refraction,
                          const ParameterValues& parameters) {
    const std::array push = {parameters.whole("nearby-steps"), parameters.whole("nearby-binary-steps")};
    recorder.compute_indirect(
        frame.workspace.compute(shaders::nearby_geometry_comp),
        {frame.bindings(), layers.bindings(), refraction.bindings(), writes("path_radiance", *refraction.radiance)},
        push, layers.covered);
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const BackFaces back =
        draw_back_faces(recorder, frame, frame.scene.refractive, BackFace(parameters.whole("back-face")));
    const std::uint32_t side = parameters.whole("table");
    const Distances distances = distances_of(parameters);
    const wyman_2005::BakedDistances baked = wyman_2005::baked_distances(frame.scene, distances, side);

    const Recorder::Scope scope(recorder, "trace");
    const bool nearby = !frame.scene.opaque.empty();
    const Refraction refraction = clear_refraction(recorder, frame, nearby);
    recorder.compute_indirect(
        frame.workspace.compute(shaders::wyman_2005_comp, {{"kSampled", distances == Distances::kSampled}}),
        {frame.bindings(), layers.bindings(), refraction.bindings(), reads("back_depth", back.depth),
         reads("back_normal", back.normal), reads("BakedObjects", baked.objects), reads("Distances", baked.values)},
        side, layers.covered);
    if (nearby) find_nearby_geometry(recorder, frame, layers, refraction, parameters);
    return refraction;
}

}  // namespace

constexpr Technique kWyman2005{
    .info = {.name = "wyman-2005",
             .summary = "two interfaces: the second guessed from the distance to the back faces and baked distances",
             .source = {"Chris Wyman", "An Approximate Image-Space Approach for Interactive Refraction",
                        "ACM Transactions on Graphics 24 (SIGGRAPH)", 2005, "section 3"},
             .parameters = kParameters,
             .bakes = true,
             .opaque_behind = true},
    .programs = {&shaders::nearby_geometry_comp, &shaders::wyman_2005_comp},
    .layer_count = [](const ParameterValues&) { return 1u; },
    .prepare = prepare,
    .record = record,
    .searches_layers = true,
};

}  // namespace pellucid
