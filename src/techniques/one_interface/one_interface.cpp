#include "techniques/one_interface/one_interface.h"
#include "techniques/shaders.h"

namespace pellucid {
namespace {

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues&) {
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame);
    recorder.compute_indirect(frame.workspace.compute(shaders::one_interface_comp),
                              {frame.bindings(), layers.bindings(), refraction.bindings()}, layers.covered);
    return refraction;
}

}  // namespace

constexpr Technique kOneInterface{
    .info = {.name = "one-interface",
             .summary = "refraction at the first interface only: what engines draw",
             .source = {},
             .parameters = {}},
    .programs = {&shaders::one_interface_comp},
    .layer_count = [](const ParameterValues&) { return 1u; },
    .record = record,
};

}  // namespace pellucid
