#pragma once

#include "gpu/gpu_scene.h"
#include "gpu/volume_images.h"
#include "volume/wavefront.h"

#include <pellucid/voxelize.h>

#include <optional>
#include <string>
#include <vector>

namespace pellucid {

/// The volumes of a scene on the device, including the volume of its voxelised glass, and the light in them.
class SceneVolumes final : public PreparedState {
public:
    explicit SceneVolumes(const Device& device) : device_(device), tracer_(device) {}

    /// Brings the volumes up to date. `voxels`: if given, all solids of glass become one more volume. Marks the
    /// replaced objects in the scene's topology.
    void bring_up_to_date(const Scene& scene, GpuScene& gpu_scene, const std::optional<VoxelSettings>& voxels);
    /// Records the tracing of lights if anything has changed. Needs lit().
    void light(Recorder& recorder, Workspace& workspace, const LightSettings& settings);

    const VolumeImages& images() const { return images_; }
    bool lit() const { return scene_ != nullptr && !scene_->lights.empty() && images_.count > 0; }
    std::uint32_t light_count() const { return std::uint32_t(tracer_.lights().size()); }
    const Buffer& lights() const { return lights_; }  ///< PunctualLight[] (gpu/punctual_light.glsl)
    const LightVolumes& light_volumes() const { return tracer_.light(); }
    const std::vector<Binding>& photons() const { return tracer_.photons(); }
    /// Like WavefrontTracer::must_repeat().
    bool must_repeat() const { return tracer_.must_repeat(); }
    /// Warnings of the volumes and of the last tracing that has run.
    std::vector<std::string> warnings() const;

private:
    void bring_lights_up_to_date();

    const Device& device_;
    const Scene* scene_ = nullptr;
    std::string made_of_;
    std::uint64_t moves_ = 0;
    VolumeImages images_;
    WavefrontTracer tracer_;
    Buffer lights_;
    std::vector<std::byte> light_bytes_;  ///< contents of `lights_`
    std::vector<std::string> warnings_;
};

}  // namespace pellucid
