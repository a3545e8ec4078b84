#pragma once

#include "gpu/recorder.h"
#include "gpu/volume_images.h"
#include "gpu/workspace.h"
#include "light/photon_store.h"
#include "volume/light_fronts.h"
#include "volume/light_records.h"
#include "volume/light_state.h"
#include "volume/volume_records.h"

#include <pellucid/scene.h>
#include <pellucid/volume_light.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace pellucid {

/// What the light of a scene leaves in its volumes; light_lookup.glsl reads it.
struct LightVolumes {
    GpuImage
        irradiance;  ///< RGBA32F: fluence rate, W/m2 (of one beam: on a surface square to it); a: 1 where there is light
    GpuImage
        direction;  ///< RGBA16F: mean way of the light, in the frame of the voxels; shorter than 1 where ways differ
    Buffer placements;  ///< gpu::LightPlacement per volume record
    Buffer shown;       ///< gpu::ShownPatch; all 0 where there is none
    std::vector<gpu::LightPlacement> placement_list;
};

/// Traces lights through the volumes of a scene, again when one of them has changed.
class WavefrontTracer {
public:
    explicit WavefrontTracer(const Device& device)
        : device_(device), photons_{KeptPhotons(device), KeptPhotons(device)} {}

    /// Records the passes if light, volumes, opaque objects or settings have changed since the last time; false if not. Where
    /// lights alone have changed, a slice of them: what is traced then is the lights of the first, and all of it is shown
    /// at once after the last, so that what is seen is `slices` - 1 to 2 `slices` - 2 updates old.
    /// `moves`: GpuScene::moves. Throws Error if the device lacks memory, or for KeptLight::kBrightest 64-bit atomics.
    bool update(Recorder& recorder, Workspace& workspace, const Scene& scene, const VolumeImages& volumes,
                const LightSettings& settings, std::uint64_t moves = 0);

    /// Traces again at the next update(), at once.
    void forget() {
        key_.clear();
        pending_.reset();
    }

    /// After update() has run: true if photons did not fit. They will, once update() has run again.
    bool must_repeat() const { return lacks_room_; }

    const LightVolumes& light() const { return light_; }
    /// Of photons on opaque surfaces, for look-ups (light/photon_store.h): what arrives of the light that lights send to
    /// volumes and, negative, what surfaces would get of it without volumes and shadows.
    const std::vector<Binding>& photons() const { return photons_[shown_].store.bindings(); }
    /// The photons that arrive. Waits for the device.
    std::vector<LandedPhoton> landed_photons(Recorder& recorder) const;
    /// Those that are shown: of the last tracing of which all slices were recorded.
    const std::vector<Light>& lights() const { return lights_; }
    /// Of the last tracing that has run.
    const LightStatistics& statistics() const { return statistics_; }

private:
    struct Tracing;
    struct KeptPhotons {
        explicit KeptPhotons(const Device& device) : workspace(device), store(device) {}
        Workspace workspace;
        PhotonStore store;
    };
    void prepare_volumes(const VolumeImages& volumes, const LightSettings& settings);
    bool prepare_opaque(const Scene& scene, std::string key);
    std::uint64_t guessed_photons() const;
    void prepare_lists(std::uint32_t capacity, bool shows);
    void begin_round(Recorder& recorder, Workspace& workspace, const Tracing& tracing);
    void begin(Recorder& recorder, Workspace& workspace, const VolumeImages& volumes, const Tracing& tracing);
    void trace_rounds(Recorder& recorder, Workspace& workspace, const VolumeImages& volumes, Tracing& tracing,
                      std::uint32_t rounds, std::uint32_t tally);
    void end(Recorder& recorder, Workspace& workspace, const Tracing& tracing);
    void finish(Recorder& recorder, Workspace& workspace, const Tracing& tracing);
    void build_photons(Recorder& recorder, const Tracing& tracing);
    void resolve_voxels(Recorder& recorder, Workspace& workspace, const Tracing& tracing);
    void leave_fewer_photons(PhotonStore& store);
    void read_statistics(const gpu::LightState& state, double power_scale, bool tally);

    const Device& device_;
    std::string key_, volume_key_, opaque_key_;
    std::shared_ptr<Tracing> pending_;  ///< of which slices are left
    std::vector<VolumeRecord> records_;
    float smallest_voxel_ = 1.0f;
    bool coarse_voxels_ = false;
    std::uint64_t voxels_ = 0;
    Buffer patches_[2], landed_;        ///< gpu::LightPatch
    Buffer step_groups_, land_groups_;  ///< numbers of workgroups
    Buffer voxel_light_, tally_, state_, tally_copy_, fronts_;
    Buffer opaque_nodes_, opaque_triangles_;  ///< gpu::OpaqueNode, gpu::OpaqueTriangle
    std::uint32_t opaque_count_ = 0;          ///< nodes
    std::array<KeptPhotons, 2> photons_;
    std::size_t shown_ = 0, filled_ = 0;  ///< of photons_: for look-ups; by the tracing
    bool lacks_room_ = false;
    float most_photons_ = 16.0f;  ///< that a patch with all its first power leaves
    LightFronts front_list_;
    LightVolumes light_;
    std::vector<Light> lights_;
    LightStatistics statistics_;
};

}  // namespace pellucid
