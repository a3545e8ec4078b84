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

/// The light in the volumes of a scene; light_lookup.glsl reads it.
struct LightVolumes {
    GpuImage irradiance;  ///< RGBA32F: fluence rate, W/m2 (for one beam, irradiance on a facing surface); a: 1 if lit
    GpuImage
        direction;  ///< RGBA16F: mean direction of the light, in the voxels' frame; shorter than 1 if directions differ
    Buffer placements;  ///< gpu::LightPlacement per volume record
    Buffer shown;       ///< gpu::ShownPatch[]; unused entries are 0
    std::vector<gpu::LightPlacement> placement_list;
};

/// Traces lights through the volumes of a scene, and again whenever lights or volumes change.
class WavefrontTracer {
public:
    explicit WavefrontTracer(const Device& device)
        : device_(device), photons_{KeptPhotons(device), KeptPhotons(device)} {}

    /// Records a tracing if lights, volumes, opaque objects or settings have changed since the last one. False if not.
    /// If only lights have changed, an update records one of `slices` slices. All slices trace the lights of the first,
    /// and the result is shown after the last. So visible light is `slices` - 1 to 2 `slices` - 2 updates old.
    /// `moves`: GpuScene::moves. Throws Error if the device lacks memory, or 64-bit atomics for KeptLight::kBrightest.
    bool update(Recorder& recorder, Workspace& workspace, const Scene& scene, const VolumeImages& volumes,
                const LightSettings& settings, std::uint64_t moves = 0);

    /// Makes the next update() trace everything again, in one slice.
    void forget() {
        key_.clear();
        pending_.reset();
    }

    /// Call after update() has run. True if photons did not fit; they will fit in the next update().
    bool must_repeat() const { return lacks_room_; }

    const LightVolumes& light() const { return light_; }
    /// Bindings of the photons on opaque surfaces, for look-ups (light/photon_store.h). Positive photons are light that
    /// has passed volumes. Negative ones are the light that surfaces would get without volumes and shadows.
    const std::vector<Binding>& photons() const { return photons_[shown_].store.bindings(); }
    /// The photons of light that has passed volumes. Waits for the device.
    std::vector<LandedPhoton> landed_photons(Recorder& recorder) const;
    /// The lights that are shown: those of the last tracing whose slices are all recorded.
    const std::vector<Light>& lights() const { return lights_; }
    /// Statistics of the last tracing that has run.
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
    std::shared_ptr<Tracing> pending_;  ///< a tracing with remaining slices
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
    std::size_t shown_ = 0, filled_ = 0;  ///< indices into photons_: for look-ups, for the tracing
    bool lacks_room_ = false;
    float most_photons_ = 16.0f;  ///< most photons of a patch with all its first power
    LightFronts front_list_;
    LightVolumes light_;
    std::vector<Light> lights_;
    LightStatistics statistics_;
};

}  // namespace pellucid
