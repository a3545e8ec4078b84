#include "techniques/wang_2014/wang_2014.h"

#include <array>

namespace pellucid {
namespace {

constexpr std::uint32_t kMergeLayers[] = {
#include "merge_layers.comp.inc"
};
constexpr std::uint32_t kShader[] = {
#include "wang_2014.comp.inc"
};

constexpr std::array kParameters = {
    ParameterInfo{"layers", "", 4, 2, 64, true, "layers peeled; entries and exits alternate"},
    ParameterInfo{"steps", "", 50, 1, 4096, true, "linear search steps n; SIZE = 1/n of the depth range"},
    ParameterInfo{"binary-steps", "", 8, 0, 24, true, "binary search steps m after a linear one"},
    ParameterInfo{"reflections", "", 1, 0, 16, true, "total internal reflections followed per exit"},
};

std::uint32_t layer_count(const ParameterValues& parameters) { return parameters.whole("layers"); }

/// Section 3.5.2: a deeper layer that is empty takes the layer of its kind before it.
const GpuImage& merge_layers(Recorder& recorder, const Frame& frame, const Layers& layers) {
    const GpuImage& merged =
        frame.workspace.image("merged layer depth", vk::Format::eR32Sfloat, frame.extent, layers.count);
    recorder.compute(frame.workspace.compute({"merge_layers.comp", kMergeLayers}),
                     {reads("layer_depth", layers.depth), writes("merged_depth", merged)}, layers.count, frame.extent);
    return merged;
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Refraction refraction = allocate_refraction(frame);
    const Recorder::Scope scope(recorder, "trace");
    const GpuImage& merged = merge_layers(recorder, frame, layers);
    const std::array push = {layers.count, parameters.whole("steps"), parameters.whole("binary-steps"),
                             parameters.whole("reflections")};
    recorder.compute(
        frame.workspace.compute({"wang_2014.comp", kShader}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
         reads("Materials", frame.scene.materials), reads("layer_depth", layers.depth),
         reads("layer_surface", layers.surface), writes("exit_direction", refraction.exit_direction),
         writes("exit_position", refraction.exit_position), writes("transmittance", refraction.transmittance),
         writes("path_events", refraction.events), reads("merged_depth", merged)},
        push, frame.extent);
    return refraction;
}

}  // namespace

constexpr Technique kWang2014{
    .info = {.name = "wang-2014",
             .summary = "four depth-peeled layers, linear and binary search, fault zones, total internal reflection",
             .source = {"Wang Shi-Hao", "Image Space Real-time Multi-refraction Technology",
                        "master's thesis, National Chengchi University", 2014, "chapter 3"},
             .parameters = kParameters},
    .layer_count = layer_count,
    .record = record,
};

}  // namespace pellucid
