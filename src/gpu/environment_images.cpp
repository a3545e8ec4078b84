#include "gpu/environment_images.h"

#include "gpu/shaders.h"
#include "gpu/structs.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

constexpr auto kFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr std::uint32_t kPyramidSize = PELLUCID_PYRAMID_SIZE, kFilterSize = PELLUCID_FILTER_SIZE;

GpuImage sampled_image(const Device& device, const char* name, vk::Extent2D extent) {
    using Usage = vk::ImageUsageFlagBits;
    return {device, name, kFormat, extent, 1, Usage::eSampled | Usage::eStorage | Usage::eTransferSrc};
}

/// Samples along the side of a pyramid texel. They are denser than the map's texels, so that no texel is missed.
std::uint32_t samples_per_side(const Environment& environment) {
    constexpr std::uint32_t kOfFormula = 4, kLeast = 4, kMost = 32;
    if (environment.kind != Environment::Kind::kMap) return kOfFormula;
    // The widest texels, at the centre of an octahedron's face, span sqrt(3 sqrt(3)) * 2 / size radians.
    constexpr float kTexelsAround = 2.7563f * float(kPyramidSize);  // 2 pi divided by that angle
    return std::clamp(std::uint32_t(2.0f * float(environment.map.width) / kTexelsAround), kLeast, kMost);
}

}  // namespace

void set_environment(gpu::FrameConstants& constants, const Environment& environment) {
    constants.environment_kind = std::uint32_t(environment.kind);
    constants.environment_uniform = glm::vec4(environment.uniform_radiance, 0.0f);
    constants.environment_cosine = std::cos(environment.rotation);
    constants.environment_sine = std::sin(environment.rotation);
    constants.environment_intensity = environment.intensity;
    const auto coefficients = irradiance_coefficients(environment);
    for (std::size_t i = 0; i < coefficients.size(); ++i) constants.irradiance[i] = glm::vec4(coefficients[i], 0.0f);
}

GpuImage upload_environment(const Device& device, const Environment& environment) {
    const bool map = environment.kind == Environment::Kind::kMap;
    const Image image = map ? environment.map : Image(1, 1, 3);
    GpuImage result(device, "the environment map", kFormat, {std::uint32_t(image.width), std::uint32_t(image.height)},
                    1, vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst);
    upload_rgb(device, result, image);
    return result;
}

FilteredEnvironment::FilteredEnvironment(const Device& device)
    : pyramid(sampled_image(device, "the environment's pyramid", {kPyramidSize + kPyramidSize / 2, kPyramidSize})),
      filtered(sampled_image(device, "the filtered environment", {PELLUCID_FILTER_WIDTH, kFilterSize})) {}

void FilteredEnvironment::filter(Workspace& workspace, Recorder& recorder, const Environment& environment,
                                 const GpuImage& map) const {
    struct Push {
        glm::vec4 uniform_radiance;
        float cosine, sine, intensity;
        std::uint32_t samples;
    };
    const Push push{glm::vec4(environment.uniform_radiance, 0.0f), std::cos(environment.rotation),
                    std::sin(environment.rotation), environment.intensity, samples_per_side(environment)};
    recorder.compute(
        workspace.compute(shaders::sample_environment_comp, {{"kEnvironmentKind", std::uint32_t(environment.kind)}}),
        {reads_layer("environment_map", map, 0), writes("pyramid", pyramid)}, push, {kPyramidSize, kPyramidSize});
    for (std::int32_t level = 1; level < PELLUCID_PYRAMID_LEVELS; ++level) {
        recorder.compute(workspace.compute(shaders::halve_environment_comp), {updates("pyramid", pyramid)}, level,
                         {kPyramidSize >> level, kPyramidSize >> level});
    }
    recorder.compute(workspace.compute(shaders::filter_environment_comp),
                     {reads_layer("pyramid", pyramid, 0), writes("filtered_environment", filtered)}, filtered.extent());
    recorder.compute(workspace.compute(shaders::tabulate_facets_comp), {writes("filtered_environment", filtered)},
                     {PELLUCID_FACET_TABLE_SIZE, PELLUCID_FACET_TABLE_SIZE});
    recorder.compute(workspace.compute(shaders::tabulate_irradiance_comp),
                     {reads_layer("pyramid", pyramid, 0), writes("filtered_environment", filtered)},
                     {PELLUCID_FACET_TABLE_SIZE, PELLUCID_FACET_TABLE_SIZE});
}

GpuImage no_filtered_environment(const Device& device) {
    return sampled_image(device, "no filtered environment", {1, 1});
}

}  // namespace pellucid
