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
    // Beside the object there is neither entry nor exit; a ray there counts as outside: in front of entries and
    // behind exits.
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const float beside = layer % 2 == 0 ? float(PELLUCID_EMPTY_DEPTH) : -float(PELLUCID_EMPTY_DEPTH);
        recorder.clear_layer(merged, layer, vk::ClearColorValue(std::array{beside, 0.0f, 0.0f, 0.0f}));
    }
    recorder.compute_indirect(
        frame.workspace.compute({"merge_layers.comp", kMergeLayers}),
        {reads("layer_depth", layers.depth), reads("PixelList", layers.covered), writes("merged_depth", merged)},
        layers.count, layers.covered);
    return merged;
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame);
    const GpuImage& merged = merge_layers(recorder, frame, layers);
    const std::array push = {layers.count, parameters.whole("steps"), parameters.whole("binary-steps"),
                             parameters.whole("reflections")};
    recorder.compute_indirect(
        frame.workspace.compute({"wang_2014.comp", kShader}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
         reads("Materials", frame.scene.materials), reads("layer_depth", layers.depth),
         reads("layer_triangle", layers.triangle), reads("layer_normal", layers.normal),
         reads("PixelList", layers.covered), writes("exit_direction", refraction.exit_direction),
         writes("exit_position", refraction.exit_position), writes("transmittance", refraction.transmittance),
         writes("path_events", refraction.events), reads("merged_depth", merged)},
        push, layers.covered);
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
