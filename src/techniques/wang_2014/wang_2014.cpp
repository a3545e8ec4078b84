#include "techniques/wang_2014/wang_2014.h"

#include "techniques/shaders.h"
#include "techniques/wang_2014/object_passes.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace pellucid {
namespace {

constexpr NamedValue kBelowFaults[] = {{0, "wait", "until the layer comes below them"},
                                       {1, "deeper", "they follow deeper layers, as in section 5.2"},
                                       {2, "from-start", "so do those that begin below a fault"}};
constexpr NamedValue kSizeRanges[] = {{0, "box", "of the object's box"}, {1, "eye", "from the eye to the glass's end"}};

constexpr std::array kParameters = {
    ParameterInfo{"layers", "", 4, 2, 64, true, "layers peeled; entries and exits alternate"},
    ParameterInfo{"steps", "", 50, 1, 4096, true, "linear search steps n; SIZE = 1/n of the depth range"},
    ParameterInfo{"binary-steps", "", 8, 0, 24, true, "binary search steps m after a linear one"},
    ParameterInfo{"reflections", "", 1, 0, 16, true, "total internal reflections followed per exit"},
    ParameterInfo{"below-faults", "", 1, 0, 2, true, "rays that come below a fault of their layer", kBelowFaults},
    ParameterInfo{"front-exits", "", 1, 0, 1, true, "reflected rays leave through layers 1 and 3, too", kOffOn},
    ParameterInfo{"silhouettes", "", 1, 0, 1, true, "a step beyond the silhouette is refined to what it stepped over",
                  kOffOn},
    ParameterInfo{"size-range", "", 0, 0, 1, true, "depth range of which SIZE is a share", kSizeRanges},
    ParameterInfo{"steep-walls", "", 1, 0, 1, true, "a jump of a layer to the outside is a wall, no fault", kOffOn},
    ParameterInfo{"footprint", "", 0, 0, 16, true,
                  "samples along a side of a pixel's footprint in the environment; 0: one direction"},
    ParameterInfo{"count-steps", "", 0, 0, 1, true, "path-length holds the number of search steps, not metres", kOffOn},
};

/// Axis-aligned box in view space: x, y and depth, m.
struct ViewBox {
    glm::vec3 low, high;
};

/// Box around `corners` in world space, limited to the space in front of the camera.
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

/// SIZE of section 3.5.3, m.
float size_of(const ViewBox& box, const gpu::FrameConstants& view, const ParameterValues& parameters) {
    const bool of_frustum = parameters.whole("size-range") != 0;
    const float range = of_frustum ? view.glass_far : box.high.z - box.low.z;
    return range / float(parameters.whole("steps"));
}

std::uint32_t layer_count(const ParameterValues& parameters) { return parameters.whole("layers"); }

/// Index of a solid in the scene, and the view depth of its box centre, m.
struct SortedSolid {
    std::size_t number;
    float depth;
};

std::span<const glm::vec3> box_corners(const GpuScene& scene, std::size_t solid) {
    return std::span(scene.refractive_corners).subspan(8 * solid, 8);
}

/// Section 3.7: nearest solid first; ties keep the order of the file.
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
    Refraction refraction = clear_refraction(recorder, frame);
    refraction.footprint = parameters.whole("footprint");
    const gpu::FrameConstants& view = frame.view;
    const GpuScene& scene = frame.scene;
    // The layers of all solids serve a single solid, unless opaque objects hide a part of it.
    const bool alone = scene.refractive.size() == 1 && !frame.has_opaque();
    for (const SortedSolid& solid : sort_solids(scene, view)) {
        const DrawCall& call = scene.refractive[solid.number];
        // Through glass, surfaces may be visible that opaque objects hide from the eye.
        const Layers own = alone ? layers
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
                             .binary_steps = parameters.whole("binary-steps"),
                             .fault_size = size_of(box, view, parameters)},
                            {.below_faults = parameters.whole("below-faults"),
                             .front_exits = parameters.whole("front-exits") != 0,
                             .steep_walls = parameters.whole("steep-walls") != 0,
                             .counts_steps = parameters.whole("count-steps") != 0,
                             .silhouettes = parameters.whole("silhouettes") != 0});
        const Buffer* rays = &layers.covered;
        for (std::uint32_t entry = 0; entry + 1 < own.count; entry += 2) {
            const bool from_eye = alone && entry == 0;
            const Buffer& inside = from_eye ? *rays : passes.enter(*rays, entry);
            rays = &passes.leave(inside, entry + 1, parameters.whole("reflections"), from_eye);
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
    .programs = {&shaders::merge_layers_comp, &shaders::enter_solid_comp, &shaders::leave_solid_comp},
    .layer_count = layer_count,
    .record = record,
    .searches_layers = true,
};

}  // namespace pellucid
