#include "techniques/irradiance/irradiance_cache.h"

#include "gpu/camera_constants.h"
#include "techniques/shaders.h"
#include "techniques/visibility_layers/visibility_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace pellucid {
namespace {

/// Pixels per gathering ray along each axis: a quarter of a frame's pixels gather.
constexpr std::uint32_t kGatherStep = 2;
/// Spacing of nodes in the first frame, pixels. A node of a surface that faces the eye then has 144 samples.
constexpr float kNodeSpacing = 24.0f;
/// The spacing falls with this power of the number of frames. The blur of a still then vanishes, slowly enough for
/// noise to vanish too.
constexpr float kShrinking = -1.0f / 6.0f;
/// Most frames that add to the cache. It has then converged, and counts fit 32 bits.
constexpr std::uint32_t kMostFrames = 4096;
/// Integer units of a sum per unit of the scene's brightness.
constexpr float kUnits = 16777216.0f;

/// Twins in light/irradiance_cells.glsl.
struct IrradianceGrid {
    glm::vec4 eye;
    float spacing, unit;
    std::uint32_t orthographic, slot_mask, lost, weight, unused[2];
};
static_assert(sizeof(IrradianceGrid) == 48);
constexpr vk::DeviceSize kNodeSize = 48;

/// Frames reflect light found by earlier frames, so later samples contain more light. From frame 4 to 16 weights grow
/// as the square of the frame's index n. The missing light at reflectance r then falls as n^(3r - 3), not as n^(r -
/// 1). The mean is as noisy as that of 5 n / 9 equal samples. Later weights are constant, so that counts fit.
std::uint32_t weight_of(std::uint32_t frame) { return std::clamp(frame * frame / 16, 1u, 16u); }

/// The same view with fewer pixels, each sampled at a point that changes between frames.
gpu::FrameConstants coarse_view(gpu::FrameConstants values) {
    const glm::vec2 first(values.first_x, values.first_y);
    values.film.x += first.x * values.film.z;
    values.film.y -= first.y * values.film.w;
    values.film.z *= float(kGatherStep);
    values.film.w *= float(kGatherStep);
    values.first_x = values.first_y = 0;
    values.width = (values.width + kGatherStep - 1) / kGatherStep;
    values.height = (values.height + kGatherStep - 1) / kGatherStep;
    shift_film(values, sample_jitter(values.sample_index));
    return values;
}

/// Slots for the nodes of `points` samples per frame. Each sample adds at most two nodes, and surfaces share most of
/// them.
std::uint32_t slots_for(std::uint64_t points) {
    return std::uint32_t(std::bit_ceil(std::max<std::uint64_t>(8 * points, 4096)));
}

}  // namespace

void IrradianceCache::begin(float brightness) {
    workspace_.trim();
    gathered_.reset();
    brightness_ = brightness;
    lost_ = 0;
}

void IrradianceCache::write_grid(Recorder& recorder, const Frame& frame, bool first) {
    const gpu::FrameConstants& view = frame.view;
    const std::uint32_t slots = slots_for(std::uint64_t(frame.extent.width) * frame.extent.height / 4);
    nodes_ = &workspace_.buffer("nodes of irradiance", sizeof(IrradianceGrid) + slots * kNodeSize);
    if (first) {
        recorder.fill(*nodes_, 0);
        frames_ = 0;
    }
    ++frames_;
    const IrradianceGrid grid{
        view.world_from_view[3],
        kNodeSpacing * std::pow(float(frames_), kShrinking) * std::sqrt(view.film.z * view.film.w),
        brightness_ / kUnits,
        view.orthographic,
        slots - 1,
        0,
        weight_of(frames_),
        {}};
    recorder.write(*nodes_, grid);
}

void IrradianceCache::gather(Recorder& recorder, const Frame& frame, bool first) {
    if (!first && frames_ >= kMostFrames) return;
    const bool again = gathered_.has_value();
    const gpu::FrameConstants values = coarse_view(frame.view);
    const Buffer& constants = workspace_.buffer("constants of gathering", sizeof(values));
    recorder.write(constants, values);
    gathered_.emplace(seen_from(frame, workspace_, constants, values, {values.width, values.height}));
    gathered_->light = frame.light;
    gathered_->photons = frame.photons;
    gathered_->environment_shares = frame.environment_shares;
    if (!again) write_grid(recorder, frame, first);
    bindings_ = {reads("IrradianceNodes", *nodes_)};
    // Surfaces found by rays reflect the light that earlier frames stored.
    if (frames_ > 1) {
        gathered_->irradiance = &bindings_;
        gathered_->bounces_before_cache = 1;
    }
    source_.begin_frame(LayerBuilder::kCompute);
    const std::uint64_t texels = std::uint64_t(values.width) * values.height;
    points_ = &workspace_.buffer("points of irradiance", texels * 16);
    const Recorder::Scope scope(recorder, "irradiance");
    const Gathered found = gather_irradiance(recorder, *gathered_, source_, *points_);
    radiance_ = &found.irradiance;
    sky_ = &found.sky;
}

void IrradianceCache::store(Recorder& recorder) {
    if (!gathered_) return;
    const Recorder::Scope scope(recorder, "irradiance");
    // The first frame had no cache to read, so its samples lack light; the second frame's samples replace them.
    if (frames_ == 2) recorder.fill(*nodes_, sizeof(IrradianceGrid), VK_WHOLE_SIZE, 0);
    recorder.compute(workspace_.compute(shaders::store_irradiance_comp),
                     {gathered_->bindings(), reads("path_radiance", *radiance_), reads("reflected_radiance", *sky_),
                      updates("IrradiancePoints", *points_), updates("IrradianceNodes", *nodes_)},
                     gathered_->extent);
    recorder.read<std::uint32_t>(*nodes_, offsetof(IrradianceGrid, lost), [this](std::uint32_t n) { lost_ += n; });
    gathered_.reset();
}

void IrradianceCache::report(std::vector<std::string>& warnings) const {
    if (lost_ > 0)
        warnings.push_back(
            fmt::format("the cache of irradiance is full: {} sums are lost, and bounces noisier", lost_));
}

}  // namespace pellucid
