#include "render/solid_lighting.h"

#include "light/light_views.h"
#include "render/local_thickness.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pellucid {

void check_thickness(const ThicknessSettings& settings, const Device& device) {
    const std::uint32_t sides = device.limits().maxImageDimension2D, most = device.limits().maxImageArrayLayers;
    if (settings.resolution < 2 || settings.resolution > sides) {
        throw Error(fmt::format("thickness: maps of {} texels along a side; {} has 2 to {}", settings.resolution,
                                device.info().name, sides));
    }
    if (settings.layers == 0 || settings.layers > most) {
        throw Error(fmt::format("thickness: {} layers; {} has 1 to {}", settings.layers, device.info().name, most));
    }
}

LayerBuilder SolidLighting::builder_for(ThicknessMethod method, std::vector<std::string>& warnings) const {
    const auto peel_instead = [&](const char* lacking) {
        warnings.push_back(
            fmt::format("{} {}: the light's layers are peeled one by one", device_.info().name, lacking));
        return LayerBuilder::kDepthPeeling;
    };
    switch (method) {
        case ThicknessMethod::kLayers:
            if (device_.is_cpu()) return LayerBuilder::kCompute;
            return device_.fragment_atomics() ? LayerBuilder::kSinglePass
                                              : peel_instead("has no fragment-shader atomics");
        case ThicknessMethod::kDualDepthPeeling:
            return device_.float_blending() ? LayerBuilder::kDualDepthPeeling
                                            : peel_instead("does not blend 32-bit floats");
        case ThicknessMethod::kTranslucentShadowMap:
        case ThicknessMethod::kLocalThickness:
        case ThicknessMethod::kDepthPeeling:
        case ThicknessMethod::kPublishedShadowMap:
        case ThicknessMethod::kPublishedLocalThickness:
        case ThicknessMethod::kPublishedDepthPeeling:
            break;
    }
    return LayerBuilder::kDepthPeeling;
}

void SolidLighting::begin(const ThicknessSettings& settings, std::span<const std::uint32_t> lights, const Scene& scene,
                          const GpuScene& gpu_scene, bake::BakeCache& cache, std::uint32_t threads,
                          const Progress& progress, std::vector<std::string>& warnings) {
    TransmittedLightSetup setup;
    setup.method = settings.method;
    setup.layers = settings.layers;
    setup.resolution = settings.resolution;
    setup.lights = scene.lights;
    if (!gpu_scene.translucent.empty() && !lights.empty()) {
        setup.builder = builder_for(settings.method, warnings);
        for (const std::uint32_t light : lights) {
            std::vector<LightView> views = light_views(scene.lights.at(light), light, gpu_scene.translucent_corners,
                                                       gpu_scene.bounds, settings.resolution);
            setup.views.insert(setup.views.end(), views.begin(), views.end());
        }
        if (is_baked(settings.method)) {
            if (!local_ || local_moves_ != gpu_scene.moves || local_method_ != settings.method) {
                local_.reset();
                local_.emplace(
                    bake_local_thickness(device_, scene, settings.method, cache, threads, progress, warnings));
                local_moves_ = gpu_scene.moves;
                local_method_ = settings.method;
            }
            setup.local = &*local_;
        }
    }
    transmitted_.begin(std::move(setup));
}

void SolidLighting::forget() {
    local_.reset();
    transmitted_.begin({});
    transmitted_.forget();
}

}  // namespace pellucid
