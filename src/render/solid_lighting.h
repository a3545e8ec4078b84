#pragma once

#include "bake/bake_cache.h"
#include "gpu/gpu_scene.h"
#include "shade/transmitted_light.h"

#include <pellucid/progress.h>
#include <pellucid/thickness.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// Throws Error for settings that the device has no room for.
void check_thickness(const ThicknessSettings& settings, const Device& device);

/// How thickness is found in the scene that is drawn: the light's views, and what is baked.
class SolidLighting {
public:
    explicit SolidLighting(const Device& device) : device_(device), transmitted_(device) {}

    /// For a picture lit by `lights` of the scene, by number. Warns of what is not closed, and where the device has no
    /// means for the builder that the method names.
    void begin(const ThicknessSettings& settings, std::span<const std::uint32_t> lights, const Scene& scene,
               const GpuScene& gpu_scene, bake::BakeCache& cache, std::uint32_t threads, const Progress& progress,
               std::vector<std::string>& warnings);
    /// Another scene is about to be set.
    void forget();
    TransmittedLight& transmitted() { return transmitted_; }

private:
    LayerBuilder builder_for(ThicknessMethod method, std::vector<std::string>& warnings) const;

    const Device& device_;
    TransmittedLight transmitted_;
    std::optional<LocalThickness> local_;
    std::uint64_t local_moves_ = 0;  ///< GpuScene::moves when it was baked
};

}  // namespace pellucid
