#include "techniques/wang_2014/wang_2014.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>

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

/// Twin of Push in wang_2014.comp.
struct Push {
    glm::vec4 box_low, box_high;
    std::uint32_t layer_count, linear_steps, binary_steps, reflections;
};

/// Axis-aligned in view space: x and y, and depth, m.
struct ViewBox {
    glm::vec3 low, high;
};

/// Around `corners` of the world, kept in front of the camera.
ViewBox view_box(const gpu::FrameConstants& view, std::span<const glm::vec3> corners) {
    ViewBox box{glm::vec3(std::numeric_limits<float>::max()), glm::vec3(std::numeric_limits<float>::lowest())};
    for (const glm::vec3& corner : corners) {
        const glm::vec3 p = glm::vec3(view.view_from_world * glm::vec4(corner, 1.0f)) * glm::vec3(1.0f, 1.0f, -1.0f);
        box.low = glm::min(box.low, p);
        box.high = glm::max(box.high, p);
    }
    box.low.z = std::max(box.low.z, view.near_plane);
    box.high.z = std::max(box.high.z, box.low.z);
    return box;
}

std::uint32_t layer_count(const ParameterValues& parameters) { return parameters.whole("layers"); }

struct MergedLayers {
    const GpuImage& depth;
    const GpuImage& normal;
};

/// Section 3.5.2: a deeper layer that is empty takes the layer of its kind before it.
MergedLayers merge_layers(Recorder& recorder, const Frame& frame, const Layers& layers) {
    Workspace& workspace = frame.workspace;
    const GpuImage& depth =
        workspace.image("merged layer depth", vk::Format::eR32Sfloat, frame.extent, layers.count);
    const GpuImage& normal = workspace.image("merged layer normal", vk::Format::eR32Uint, frame.extent, layers.count);
    // Beside the object there is neither entry nor exit; a ray there counts as outside: in front of entries and
    // behind exits.
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const float beside = layer % 2 == 0 ? float(PELLUCID_EMPTY_DEPTH) : -float(PELLUCID_EMPTY_DEPTH);
        recorder.clear_layer(depth, layer, vk::ClearColorValue(std::array{beside, 0.0f, 0.0f, 0.0f}));
    }
    recorder.clear(normal, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.compute_indirect(workspace.compute({"merge_layers.comp", kMergeLayers}),
                              {reads("layer_depth", layers.depth), reads("layer_normal", layers.normal),
                               reads("PixelList", layers.covered), writes("merged_depth", depth),
                               writes("merged_normal", normal)},
                              layers.count, layers.covered);
    return {depth, normal};
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Recorder::Scope scope(recorder, "trace");
    const Refraction refraction = clear_refraction(recorder, frame);
    const MergedLayers merged = merge_layers(recorder, frame, layers);
    gpu::FrameConstants view{};
    std::memcpy(&view, frame.constants.mapped(), sizeof(view));
    const ViewBox box = view_box(view, frame.scene.refractive_corners);
    const Push push{glm::vec4(box.low, 0.0f), glm::vec4(box.high, 0.0f), layers.count, parameters.whole("steps"),
                    parameters.whole("binary-steps"), parameters.whole("reflections")};
    recorder.compute_indirect(
        frame.workspace.compute({"wang_2014.comp", kShader}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects),
         reads("Materials", frame.scene.materials), reads("layer_depth", layers.depth),
         reads("layer_triangle", layers.triangle), reads("layer_normal", layers.normal),
         reads("PixelList", layers.covered), writes("exit_direction", refraction.exit_direction),
         writes("exit_position", refraction.exit_position), writes("transmittance", refraction.transmittance),
         writes("path_events", refraction.events), reads("merged_depth", merged.depth),
         reads("merged_normal", merged.normal)},
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
