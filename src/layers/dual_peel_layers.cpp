// Dual depth peeling finds two depths per geometry pass, one from either side: Bavoil & Myers, "Order Independent
// Transparency with Dual Depth Peeling", NVIDIA 2008. Both sides are joined into one list as by Chen, translucency by
// measured thickness. Needs Device::float_blending().
//
// Blending finds only depths. The next pass collects the triangles that lie at these depths. So n layers take n/2 + 1
// passes if no view ray crosses more than n surfaces. Otherwise the two sides do not meet within these passes, and up
// to n + 1 passes are needed.
#include "layers/layer_images.h"
#include "layers/shaders.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace pellucid {
namespace {

constexpr vk::Format kSideFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr std::uint64_t kMostTriangles = 0x7f000000u / 2;  // number of keys that dual_peel.glsl can distinguish

bool too_many_triangles(const Frame& frame, std::span<const DrawCall> solids) {
    return std::any_of(solids.begin(), solids.end(), [&](const DrawCall& call) {
        return std::uint64_t(frame.scene.first_triangles[call.object]) + call.corner_count / 3 > kMostTriangles;
    });
}

/// Either side's texels, a slice per pass.
struct Sides {
    const GpuImage& near_side;
    const GpuImage& far_side;
};

Sides peel_both_sides(Recorder& recorder, const Frame& frame, const Opaque& opaque, std::span<const DrawCall> solids,
                      std::uint32_t passes) {
    Workspace& workspace = frame.workspace;
    const Program& program = workspace.graphics({.vertex = shaders::layer_vert,
                                                 .fragment = shaders::dual_peel_layers_frag,
                                                 .colors = {kSideFormat, kSideFormat},
                                                 .blend = Blend::kMaxAddAlpha});
    // Requests of one frame may need different numbers of passes, so the names contain the number.
    const Sides sides{workspace.image(fmt::format("near side of {} passes", passes), kSideFormat, frame.extent, passes),
                      workspace.image(fmt::format("far side of {} passes", passes), kSideFormat, frame.extent, passes)};
    const vk::ClearValue nothing = vk::ClearColorValue(std::array{-float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f});
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const RenderTarget target{.extent = frame.extent,
                                  .colors = {{&sides.near_side, pass, nothing}, {&sides.far_side, pass, nothing}}};
        // The first pass reads neither image, but an image of the right kind has to be bound.
        const bool first = pass == 0;
        const std::uint32_t last = first ? 0 : pass - 1;
        recorder.draw(program,
                      {frame.bindings(), reads_layer("last_near", first ? opaque.radiance : sides.near_side, last),
                       reads_layer("last_far", first ? opaque.radiance : sides.far_side, last)},
                      first ? 1u : 0u, target, solids);
    }
    return sides;
}

}  // namespace

Layers LayerSource::peel_dual(Recorder& recorder, const Frame& frame, const Opaque& opaque,
                              const LayerRequest& request) {
    if (dual_.crowded || too_many_triangles(frame, request.solids)) return peel(recorder, frame, opaque, request);

    const std::uint32_t peels = std::min(request.count, (request.count + 1) / 2 + dual_.extra_peels);
    const Sides sides = peel_both_sides(recorder, frame, opaque, request.solids, peels + 1);
    geometry_passes_ += peels + 1;

    const LayerImages images = allocate_layers(frame, request);
    const Buffer& counters = frame.workspace.buffer("peel counters", sizeof(glm::uvec2));
    recorder.fill(counters, 0);
    recorder.clear(images.depth, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
    recorder.clear(images.triangle, vk::ClearColorValue(std::array{PELLUCID_NO_TRIANGLE, 0u, 0u, 0u}));
    recorder.compute(frame.workspace.compute(shaders::order_layers_comp),
                     {reads("near_side", sides.near_side), reads("far_side", sides.far_side),
                      reads("opaque_depth", opaque.depth), writes("layer_depth", images.depth),
                      writes("layer_triangle", images.triangle), updates("PeelCounters", counters)},
                     std::array{request.count, request.hidden_by_opaque ? 1u : 0u, peels}, frame.extent);
    recorder.read<glm::uvec2>(counters, 0, [this](const glm::uvec2& counted) {
        dual_.counted = glm::max(dual_.counted.value_or(counted), counted);
    });
    return finish_layers(recorder, frame, images, opaque, request, *this);
}

// Sides that have not met do not reveal how many passes are missing. So the frame is drawn again with the largest
// number of passes, and counts the needed ones.
bool LayerSource::must_peel_more() {
    if (!dual_.counted) return false;
    const auto [extra_peels, crowded] = std::pair(dual_.counted->x, dual_.counted->y);
    dual_.counted.reset();
    if (crowded > 0) {
        dual_.crowded = true;
        return true;
    }
    const bool more = extra_peels > dual_.extra_peels;
    if (more || dual_.measuring) dual_.extra_peels = extra_peels;
    dual_.measuring = more;
    return more;
}

}  // namespace pellucid
