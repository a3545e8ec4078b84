#include "techniques/wyman_2005/wyman_2005.h"

#include "layers/back_faces.h"
#include "techniques/shaders.h"
#include "techniques/wyman_2005/baked_distances.h"

#include <array>

namespace pellucid {
namespace {

using wyman_2005::Distances;

constexpr NamedValue kDistances[] = {{0, "blended", "between the view ray's and the normal's"},
                                     {1, "sampled", "from a table of samples"},
                                     {2, "view-ray", "the view ray's alone"}};

constexpr std::array kParameters = {
    ParameterInfo{"back-face", "", 0, 0, 1, true, "far side of the glass", kBackFaceNames},
    ParameterInfo{"distances", "", 0, 0, 2, true, "length of the way through the glass", kDistances},
    ParameterInfo{"table", "", 64, 4, 64, true,
                  "points and directions along a side of the table; it has their 4th power"},
    ParameterInfo{"nearby-steps", "", 64, 1, 4096, true, "linear steps in search of opaque objects behind the glass"},
    ParameterInfo{"nearby-binary-steps", "", 6, 0, 24, true, "binary steps after a linear one"},
    ParameterInfo{"inner-reflections", "", 0, 0, 16, true,
                  "total reflections followed between the pictures of front and back; then the angle is clamped"},
    ParameterInfo{"bounce-steps", "", 64, 1, 4096, true, "linear steps in search of the wall behind such a reflection"},
};

constexpr std::uint32_t kBounceBinarySteps = 6;

Distances distances_of(const ParameterValues& parameters) { return Distances(parameters.whole("distances")); }

void prepare(const Preparation& preparation, const ParameterValues& parameters) {
    if (distances_of(parameters) == Distances::kAlongView) return;
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

/// Those that prepare() has baked; what is bound in their place where it bakes none.
wyman_2005::BakedDistances baked_for(const Frame& frame, Distances distances, std::uint32_t table_side) {
    if (distances != Distances::kAlongView) return wyman_2005::baked_distances(frame.scene, distances, table_side);
    return {frame.workspace.buffer("no distances", 16), frame.workspace.buffer("no baked objects", 96)};
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const BackFaces back =
        draw_back_faces(recorder, frame, frame.scene.refractive, BackFace(parameters.whole("back-face")));
    const Distances distances = distances_of(parameters);
    const std::array push = {parameters.whole("table"), parameters.whole("bounce-steps"), kBounceBinarySteps};
    const wyman_2005::BakedDistances baked = baked_for(frame, distances, push[0]);

    const Recorder::Scope scope(recorder, "trace");
    const bool nearby = frame.has_opaque();
    const Refraction refraction = clear_refraction(recorder, frame, nearby);
    recorder.compute_indirect(
        frame.workspace.compute(shaders::wyman_2005_comp,
                                {{"kSampled", distances == Distances::kSampled},
                                 {"kAlongView", distances == Distances::kAlongView},
                                 {"kInnerReflections", parameters.whole("inner-reflections")}}),
        {frame.bindings(), layers.bindings(), refraction.bindings(), reads("back_depth", back.depth),
         reads("back_normal", back.normal), reads("BakedObjects", baked.objects), reads("Distances", baked.values)},
        push, layers.covered);
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
