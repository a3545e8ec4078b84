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

/// Throws Error for settings beyond the device's limits.
void check_thickness(const ThicknessSettings& settings, const Device& device);

/// Thickness in the current scene: the lights' views, and baked values.
class SolidLighting {
public:
    explicit SolidLighting(const Device& device) : device_(device), transmitted_(device) {}

    /// Prepares an image lit by `lights`, indices into the scene's lights. Warns of open surfaces, and if the device
    /// does not support the method's builder.
    void begin(const ThicknessSettings& settings, std::span<const std::uint32_t> lights, const Scene& scene,
               const GpuScene& gpu_scene, bake::BakeCache& cache, std::uint32_t threads, const Progress& progress,
               std::vector<std::string>& warnings);
    /// Call before another scene is set.
    void forget();
    TransmittedLight& transmitted() { return transmitted_; }

private:
    LayerBuilder builder_for(ThicknessMethod method, std::vector<std::string>& warnings) const;

    const Device& device_;
    TransmittedLight transmitted_;
    std::optional<LocalThickness> local_;
    std::uint64_t local_moves_ = 0;  ///< GpuScene::moves at the time of baking
    ThicknessMethod local_method_ = ThicknessMethod::kLocalThickness;
};

}  // namespace pellucid
