#include "render/check_settings.h"

#include "render/aovs.h"
#include "render/solid_lighting.h"
#include "render/tiles.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr std::uint32_t kMaxSamples = 1u << 20;
constexpr std::uint32_t kMostBounces = 7;            ///< limit of the bits of a path
constexpr std::uint32_t kLongestPicture = 1u << 20;  ///< pixels; single precision resolves half pixels up to here

std::uint64_t result_bytes(const RenderSettings& settings) {
    std::uint64_t per_pixel = 2 * 3 * sizeof(float);  // radiance and display
    for (const std::string& name : settings.aovs)
        per_pixel += std::uint64_t(parse_aov(name).info->channels) * sizeof(float);
    if (settings.paths) per_pixel += sizeof(RefractedPath);
    return per_pixel * settings.width * settings.height;
}

void check_picture_size(const RenderSettings& settings) {
    const std::uint32_t width = settings.width, height = settings.height;
    if (width == 0 || height == 0 || width > kLongestPicture || height > kLongestPicture)
        throw Error(fmt::format("size {}x{}: pictures have 1x1 to {}x{} pixels", width, height, kLongestPicture,
                                kLongestPicture));
    const double needed = double(result_bytes(settings));
    const double memory = double(host_memory());
    if (needed > memory)
        throw Error(fmt::format("size {}x{}: the picture takes {:.1f} GiB of memory; this machine has {:.1f} GiB",
                                width, height, needed / double(1u << 30), memory / double(1u << 30)));
}

}  // namespace

void check_settings(const RenderSettings& settings, const Device& device) {
    check_picture_size(settings);
    if (settings.samples == 0 || settings.samples > kMaxSamples) {
        throw Error(fmt::format("samples must be 1 to {}, not {}", kMaxSamples, settings.samples));
    }
    if (settings.first_sample > kMaxSamples)
        throw Error(fmt::format("first sample must be 0 to {}, not {}", kMaxSamples, settings.first_sample));
    if (!(settings.error >= 0.0f && settings.error <= 1e6f))
        throw Error(fmt::format("error must be 0 to 1e6, not {}", settings.error));
    if (settings.most_samples == 0 || settings.most_samples > kMaxSamples)
        throw Error(fmt::format("most samples must be 1 to {}, not {}", kMaxSamples, settings.most_samples));
    if (!(std::abs(settings.exposure_ev) <= 64.0f)) {
        throw Error(fmt::format("exposure must be -64 to 64 stops, not {}", settings.exposure_ev));
    }
    if (!(settings.unit_luminance_cd_m2 >= 1e-6f && settings.unit_luminance_cd_m2 <= 1e9f)) {
        throw Error(
            fmt::format("luminance of radiance 1 must be 1e-6 to 1e9 cd/m2, not {}", settings.unit_luminance_cd_m2));
    }
    if (!(settings.adaptation_s >= 0.0f))
        throw Error(fmt::format("time to adapt must be at least 0 s, not {}", settings.adaptation_s));
    if (settings.light.bounces > kMostBounces)
        throw Error(fmt::format("bounces must be 0 to {}, not {}", kMostBounces, settings.light.bounces));
    check_thickness(settings.thickness, device);
    const auto part = std::find_if(settings.aovs.begin(), settings.aovs.end(), is_light_part);
    if (settings.view != View::kRadiance && part != settings.aovs.end())
        throw Error(fmt::format("AOV '{}' is light, which only the view radiance shows", *part));
}

}  // namespace pellucid
