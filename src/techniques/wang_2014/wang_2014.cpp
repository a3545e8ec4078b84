#include "techniques/wang_2014/wang_2014.h"

#include "layers/pixel_list.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

constexpr std::uint32_t kMergeLayers[] = {
#include "merge_layers.comp.inc"
};
constexpr std::uint32_t kEnterSolid[] = {
#include "enter_solid.comp.inc"
};
constexpr std::uint32_t kLeaveSolid[] = {
#include "leave_solid.comp.inc"
};

constexpr std::array kParameters = {
    ParameterInfo{"layers", "", 4, 2, 64, true, "layers peeled; entries and exits alternate"},
    ParameterInfo{"steps", "", 50, 1, 4096, true, "linear search steps n; SIZE = 1/n of the depth range"},
    ParameterInfo{"binary-steps", "", 8, 0, 24, true, "binary search steps m after a linear one"},
    ParameterInfo{"reflections", "", 1, 0, 16, true, "total internal reflections followed per exit"},
};

/// Twin of Push in ray_state.glsl.
struct Push {
    glm::vec4 box_low, box_high;
    std::uint32_t object;
    std::uint32_t layer = 0;
    std::uint32_t linear_steps, binary_steps;
    std::uint32_t last_reflection = 0;
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
    const GpuImage& depth = workspace.image("merged layer depth", vk::Format::eR32Sfloat, frame.extent, layers.count);
    const GpuImage& normal = workspace.image("merged layer normal", vk::Format::eR32Uint, frame.extent, layers.count);
    // Beside the object there is neither entry nor exit; a ray there counts as outside: in front of entries and
    // behind exits.
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const float beside = layer % 2 == 0 ? float(PELLUCID_EMPTY_DEPTH) : -float(PELLUCID_EMPTY_DEPTH);
        recorder.clear_layer(depth, layer, vk::ClearColorValue(std::array{beside, 0.0f, 0.0f, 0.0f}));
    }
    recorder.clear(normal, vk::ClearColorValue(std::array{0u, 0u, 0u, 0u}));
    recorder.compute_indirect(
        workspace.compute({"merge_layers.comp", kMergeLayers}),
        {reads("layer_depth", layers.depth), reads("layer_normal", layers.normal), reads("PixelList", layers.covered),
         writes("merged_depth", depth), writes("merged_normal", normal)},
        layers.count, layers.covered);
    return {depth, normal};
}

/// The passes over one object: from the rays that may meet it to those that have passed it.
class ObjectPasses {
public:
    /// `seen` are layers of all solids together, `layers` of the object alone.
    ObjectPasses(Recorder& recorder, const Frame& frame, const Layers& seen, const Layers& layers,
                 const Refraction& refraction, Push push)
        : recorder_(recorder), frame_(frame), seen_(seen), layers_(layers), refraction_(refraction), push_(push),
          merged_(merge_layers(recorder, frame, layers)) {}

    /// Rays of `pixels` look for a way in through a layer; returns the pixels of those that find one.
    const Buffer& enter(const Buffer& pixels, std::uint32_t layer, bool first_object) {
        const Buffer& inside = start_pixel_list(recorder_, frame_, "rays inside");
        push_.layer = layer;
        recorder_.compute_indirect(
            frame_.workspace.compute({"enter_solid.comp", kEnterSolid}, {first_object ? 1u : 0u}),
            {reads("Frame", frame_.constants), reads("Objects", frame_.scene.objects),
             reads("Materials", frame_.scene.materials), reads("layer_depth", layers_.depth),
             reads("layer_triangle", layers_.triangle), reads("layer_normal", layers_.normal),
             reads("seen_triangle", seen_.triangle), reads("merged_depth", merged_.depth),
             reads("merged_normal", merged_.normal), reads("PixelList", pixels), updates("Inside", inside),
             updates("exit_direction", refraction_.exit_direction), updates("exit_position", refraction_.exit_position),
             updates("transmittance", refraction_.transmittance), updates("path_events", refraction_.events)},
            push_, pixels);
        return inside;
    }

    /// Rays of `pixels` look for their way out through a layer, with total reflections in between; returns the
    /// pixels of those that find it.
    const Buffer& leave(const Buffer& pixels, std::uint32_t layer, std::uint32_t reflections) {
        const Buffer& outside = start_pixel_list(recorder_, frame_, "rays outside");
        const Buffer* searching = &pixels;
        push_.layer = layer;
        for (std::uint32_t reflection = 0; reflection <= reflections; ++reflection) {
            push_.last_reflection = reflection == reflections ? 1 : 0;
            const Buffer& reflected =
                start_pixel_list(recorder_, frame_, reflection % 2 == 0 ? "rays reflected" : "rays reflected again");
            recorder_.compute_indirect(
                frame_.workspace.compute({"leave_solid.comp", kLeaveSolid}),
                {reads("Frame", frame_.constants), reads("Objects", frame_.scene.objects),
                 reads("Materials", frame_.scene.materials), reads("layer_depth", layers_.depth),
                 reads("layer_triangle", layers_.triangle), reads("layer_normal", layers_.normal),
                 reads("merged_depth", merged_.depth), reads("merged_normal", merged_.normal),
                 reads("PixelList", *searching), updates("Outside", outside), updates("Reflected", reflected),
                 updates("exit_direction", refraction_.exit_direction),
                 updates("exit_position", refraction_.exit_position),
                 updates("transmittance", refraction_.transmittance), updates("path_events", refraction_.events)},
                push_, *searching);
            searching = &reflected;
        }
        return outside;
    }

private:
    Recorder& recorder_;
    const Frame& frame_;
    const Layers& seen_;
    const Layers& layers_;
    const Refraction& refraction_;
    Push push_;
    MergedLayers merged_;
};

/// A solid of the scene by its number, and how far the middle of its box is from the eye along the view, m.
struct SortedSolid {
    std::size_t number;
    float depth;
};

std::span<const glm::vec3> box_corners(const GpuScene& scene, std::size_t solid) {
    return std::span(scene.refractive_corners).subspan(8 * solid, 8);
}

/// Section 3.7: nearest first; of equals the first in the file.
std::vector<SortedSolid> sort_solids(const GpuScene& scene, const gpu::FrameConstants& view) {
    std::vector<SortedSolid> solids;
    for (std::size_t i = 0; i < scene.refractive.size(); ++i) {
        const std::span<const glm::vec3> corners = box_corners(scene, i);
        const glm::vec3 center = 0.5f * (corners.front() + corners.back());
        solids.push_back({i, -(view.view_from_world * glm::vec4(center, 1.0f)).z});
    }
    std::stable_sort(solids.begin(), solids.end(),
                     [](const SortedSolid& a, const SortedSolid& b) { return a.depth < b.depth; });
    return solids;
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    const Refraction refraction = clear_refraction(recorder, frame);
    gpu::FrameConstants view{};
    std::memcpy(&view, frame.constants.mapped(), sizeof(view));
    const GpuScene& scene = frame.scene;
    bool first = true;
    for (const SortedSolid& solid : sort_solids(scene, view)) {
        const DrawCall& call = scene.refractive[solid.number];
        // Seen through another object, a surface may lie where an opaque one hides it from the eye.
        const Layers own = scene.refractive.size() == 1 ? layers
                                                        : layers.source.build(recorder, frame, layers.opaque,
                                                                              {.solids = std::span(&call, 1),
                                                                               .count = parameters.whole("layers"),
                                                                               .hidden_by_opaque = false,
                                                                               .name = "object layer"});
        const ViewBox box = view_box(view, box_corners(scene, solid.number));
        const Recorder::Scope scope(recorder, "trace");
        ObjectPasses passes(recorder, frame, layers, own, refraction,
                            {.box_low = glm::vec4(box.low, 0.0f),
                             .box_high = glm::vec4(box.high, 0.0f),
                             .object = call.object,
                             .linear_steps = parameters.whole("steps"),
                             .binary_steps = parameters.whole("binary-steps")});
        const Buffer* rays = &layers.covered;
        for (std::uint32_t entry = 0; entry + 1 < own.count; entry += 2) {
            const Buffer& inside = passes.enter(*rays, entry, std::exchange(first, false));
            rays = &passes.leave(inside, entry + 1, parameters.whole("reflections"));
        }
    }
    return refraction;
}

}  // namespace

constexpr Technique kWang2014{
    .info = {.name = "wang-2014",
             .summary = "four depth-peeled layers, linear and binary search, fault zones, total internal reflection",
             .source = {"Wang Shi-Hao", "Image Space Real-time Multi-refraction Technology",
                        "master's thesis, National Chengchi University", 2014, "chapter 3"},
             .parameters = kParameters,
             .many_media = true},
    .layer_count = layer_count,
    .record = record,
};

}  // namespace pellucid
