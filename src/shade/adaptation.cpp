#include "shade/adaptation.h"

#include <algorithm>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::uint32_t kSumLogLuminance[] = {
#include "sum_log_luminance.comp.inc"
};
constexpr std::uint32_t kAdaptLuminance[] = {
#include "adapt_luminance.comp.inc"
};
constexpr std::uint32_t kKrawczyk[] = {
#include "krawczyk.comp.inc"
};

constexpr std::uint32_t kGroupSide = 16;  // of sum_log_luminance.comp, invocations
constexpr std::uint32_t kSide = 4;        // pixels of an invocation there
constexpr float kLongest = 1e6f;          // s; nothing is left of what was seen then

constexpr std::uint32_t divided(std::uint32_t count, std::uint32_t by) { return (count + by - 1) / by; }

}  // namespace

Adaptation::Adaptation(const Device& device)
    : adapted_(device, "adapted luminance", sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer, true) {}

const GpuImage& Adaptation::tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance,
                                    const Look& look) {
    struct SumPush {
        float unit_cd_m2;
        std::uint32_t side;
    };
    struct AdaptPush {
        std::uint32_t tiles;
        float pixels;
        float elapsed_s;
        std::uint32_t first;
    };
    struct MapPush {
        float unit_cd_m2;
        float exposure;
    };
    const vk::Extent2D threads{divided(frame.extent.width, kSide), divided(frame.extent.height, kSide)};
    const std::uint32_t tiles = divided(threads.width, kGroupSide) * divided(threads.height, kGroupSide);
    const float pixels = float(frame.extent.width) * float(frame.extent.height);
    Workspace& workspace = frame.workspace;
    const Buffer& sums = workspace.buffer("tile sums", tiles * sizeof(float));
    const GpuImage& display = workspace.image("display", vk::Format::eR8G8B8A8Unorm, frame.extent);
    const Recorder::Scope scope(recorder, "tonemap");
    recorder.compute(workspace.compute({"sum_log_luminance.comp", kSumLogLuminance}),
                     {reads("radiance", radiance), writes("TileSums", sums)}, SumPush{look.unit_cd_m2, kSide}, threads);
    recorder.compute(workspace.compute({"adapt_luminance.comp", kAdaptLuminance}),
                     {reads("TileSums", sums), updates("Adaptation", adapted_)},
                     AdaptPush{tiles, pixels, std::min(look.elapsed_s, kLongest), first_ ? 1u : 0u}, {1, 1});
    recorder.compute(workspace.compute({"krawczyk.comp", kKrawczyk}),
                     {reads("radiance", radiance), writes("display", display), reads("Adaptation", adapted_)},
                     MapPush{look.unit_cd_m2, look.exposure}, frame.extent);
    recorder.when_done([this] { first_ = false; });
    return display;
}

float Adaptation::adapted_cd_m2() const {
    float value = 0.0f;
    std::memcpy(&value, adapted_.mapped(), sizeof(value));
    return value;
}

}  // namespace pellucid
