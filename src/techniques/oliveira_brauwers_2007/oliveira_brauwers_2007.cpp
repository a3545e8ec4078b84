#include "techniques/oliveira_brauwers_2007/oliveira_brauwers_2007.h"

#include "layers/back_faces.h"
#include "techniques/shaders.h"

#include <array>

namespace pellucid {
namespace {

constexpr NamedValue kInterpolation[] = {{0, "nearest", "of the nearest texel"}, {1, "linear", "between texels"}};

constexpr std::array kParameters = {
    ParameterInfo{"back-face", "", 1, 0, 1, true, "far side of the glass", kBackFaceNames},
    ParameterInfo{"steps", "", 50, 1, 4096, true, "linear search steps over the part of the ray within the glass"},
    ParameterInfo{"binary-steps", "", 8, 0, 24, true, "binary search steps after a linear one"},
    ParameterInfo{"interpolate", "", 1, 0, 1, true, "depth and normal in the map", kInterpolation},
};

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const BackFaces back =
        draw_back_faces(recorder, frame, frame.scene.refractive, BackFace(parameters.whole("back-face")));
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame);
    const std::array push = {parameters.whole("steps"), parameters.whole("binary-steps"),
                             parameters.whole("interpolate")};
    recorder.compute_indirect(frame.workspace.compute(shaders::oliveira_brauwers_2007_comp),
                              {frame.bindings(), layers.bindings(), refraction.bindings(),
                               reads("back_depth", back.depth), reads("back_normal", back.normal)},
                              push, layers.covered);
    return refraction;
}

}  // namespace

constexpr Technique kOliveiraBrauwers2007{
    .info = {.name = "oliveira-brauwers-2007",
             .summary = "two interfaces, the exit found by relief-map search of the back faces",
             .source = {"Manuel M. Oliveira, Maicon Brauwers", "Real-Time Refraction Through Deformable Objects",
                        "ACM Symposium on Interactive 3D Graphics and Games (I3D)", 2007, "3"},
             .parameters = kParameters},
    .programs = {&shaders::oliveira_brauwers_2007_comp},
    .layer_count = [](const ParameterValues&) { return 1u; },
    .record = record,
    .searches_layers = true,
};

}  // namespace pellucid
