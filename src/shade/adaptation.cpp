#include "shade/adaptation.h"
#include "shade/shaders.h"

#include <algorithm>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::uint32_t kGroupSide = 16;  // workgroup side of sum_log_luminance.comp, invocations
constexpr std::uint32_t kSide = 4;        // pixels per invocation along each axis
constexpr float kLongest = 1e6f;          // s; adaptation is complete by then

constexpr std::uint32_t divided(std::uint32_t count, std::uint32_t by) { return (count + by - 1) / by; }

vk::Extent2D threads_of(vk::Extent2D pixels) { return {divided(pixels.width, kSide), divided(pixels.height, kSide)}; }

std::uint32_t sum_count(vk::Extent2D pixels) {
    const vk::Extent2D threads = threads_of(pixels);
    return divided(threads.width, kGroupSide) * divided(threads.height, kGroupSide);
}

}  // namespace

Adaptation::Adaptation(const Device& device)
    : adapted_(device, "adapted luminance", sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer, true) {}

void Adaptation::begin_picture(Workspace& workspace, std::span<const vk::Extent2D> parts) {
    std::uint32_t sums = 0;
    pixels_ = 0.0f;
    for (const vk::Extent2D part : parts) {
        sums += sum_count(part);
        pixels_ += float(part.width) * float(part.height);
    }
    sums_ = &workspace.buffer("tile sums", sums * sizeof(float));
    added_ = 0;
}

void Adaptation::add(Recorder& recorder, const Frame& frame, const GpuImage& radiance, const Look& look) {
    struct Push {
        float unit_cd_m2;
        std::uint32_t side, first_sum;
    };
    const Recorder::Scope scope(recorder, "tonemap");
    recorder.compute(frame.workspace.compute(shaders::sum_log_luminance_comp),
                     {reads("radiance", radiance), writes("TileSums", *sums_)}, Push{look.unit_cd_m2, kSide, added_},
                     threads_of(frame.extent));
    added_ += sum_count(frame.extent);
}

void Adaptation::adapt(Recorder& recorder, const Frame& frame, const Look& look) {
    struct Push {
        std::uint32_t tiles;
        float pixels;
        float elapsed_s;
        std::uint32_t first;
    };
    const Recorder::Scope scope(recorder, "tonemap");
    recorder.compute(frame.workspace.compute(shaders::adapt_luminance_comp),
                     {reads("TileSums", *sums_), updates("Adaptation", adapted_)},
                     Push{added_, pixels_, std::min(look.elapsed_s, kLongest), first_ ? 1u : 0u}, {1, 1});
    recorder.when_done([this] { first_ = false; });
}

const GpuImage& Adaptation::tonemap(Recorder& recorder, const Frame& frame, const GpuImage& radiance,
                                    const Look& look) {
    struct Push {
        float unit_cd_m2;
        float exposure;
    };
    const GpuImage& display = frame.workspace.image("display", vk::Format::eR8G8B8A8Unorm, frame.extent);
    const Recorder::Scope scope(recorder, "tonemap");
    recorder.compute(frame.workspace.compute(shaders::krawczyk_comp),
                     {reads("radiance", radiance), writes("display", display), reads("Adaptation", adapted_)},
                     Push{look.unit_cd_m2, look.exposure}, frame.extent);
    return display;
}

float Adaptation::adapted_cd_m2() const {
    float value = 0.0f;
    std::memcpy(&value, adapted_.mapped(), sizeof(value));
    return value;
}

}  // namespace pellucid
