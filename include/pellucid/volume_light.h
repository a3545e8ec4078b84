#pragma once

#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// What a voxel keeps of the light that passes it.
enum class KeptLight {
    kSum,        ///< the sum, and its mean direction
    kBrightest,  ///< the patch of greatest irradiance and its direction, as in the paper; needs 64-bit atomics
};

/// How light is traced through volumes, as wavefronts of patches. Ihrke et al. 2007, "Eikonal Rendering", section 4.2.
struct LightSettings {
    KeptLight kept = KeptLight::kSum;
    float step = 0.5f;         ///< optical length of a step, voxels, > 0
    float span = 1.0f;         ///< patches with a longer side are split, voxels, > 0
    float finest = 1.0f / 32;  ///< a patch of less than this share of its first power is not split, 0..1
    float weakest = 1e-6f;     ///< a patch of less than this share of its first power ends, 0..1
    float least_area = 0.02f;  ///< of a patch when its light is written, voxels^2: bounds what a focus is given
    bool keep_folds = true;    ///< false: a patch that has turned over ends there, as in the paper
    std::uint32_t capacity = 1u << 18;   ///< patches at once; at most what a storage buffer holds
    std::uint32_t steps_per_round = 16;  ///< of a patch before lists are compacted
    std::uint32_t slices =
        1;  ///< updates over which a light that moves is traced; until the last the one before is shown
    std::uint32_t rounds = 0;       ///< at most; 0: as many as light needs to cross all volumes one and a half times
    float photon_spacing = 0.5f;    ///< of photons where patches meet opaque surfaces, smallest voxels, > 0
    bool fresnel = true;            ///< surfaces (Volume::boundary) reflect light
    std::uint32_t reflections = 0;  ///< reflections followed one after another, 0..7; light of more is lost
    float shown_spacing =
        0.0f;            ///< optical length between the wavefronts of View::kWavefront, smallest voxels; 0: none
    bool tally = false;  ///< kBrightest: count what voxels get from several directions (lit_voxels on); traces twice
};

/// The balance of the light: power in W, for red, green and blue.
struct LightStatistics {
    glm::dvec3 emitted{0.0};    ///< towards volumes
    glm::dvec3 arrived{0.0};    ///< on opaque surfaces
    glm::dvec3 missed{0.0};     ///< left the volumes and met no surface
    glm::dvec3 absorbed{0.0};   ///< or scattered
    glm::dvec3 reflected{0.0};  ///< at surfaces, and not followed
    glm::dvec3 turned{0.0};     ///< dropped at folds
    glm::dvec3 weak{0.0};       ///< dropped as too weak
    glm::dvec3 left{0.0};       ///< still under way when the rounds ended
    std::uint32_t patches = 0;  ///< most at once
    std::uint32_t splits = 0, rounds = 0;
    std::uint32_t refused = 0;               ///< splits and reflections for which there was no room
    std::uint32_t shown = 0, not_shown = 0;  ///< patches for View::kWavefront: kept, and without room
    std::uint32_t patches_left = 0;          ///< when the rounds ended
    bool coarsened = false;                  ///< for want of room patches began larger than `span`
    bool coarse_voxels = false;              ///< for want of room voxels of light are larger than those of their volume
    std::uint64_t lit_voxels = 0;            ///< tally: voxels with light, of them
    std::uint64_t multi_voxels = 0;          ///< those in which over 1% comes from other directions than the brightest
    double main_share = 1.0;  ///< in them: share of what they get that comes within 15 degrees of the brightest
    /// What was dropped or coarsened, one line each.
    PELLUCID_API std::vector<std::string> warnings() const;
};

/// Light where it meets an opaque surface. Look-ups spread it over the disc around it.
struct LandedPhoton {
    glm::dvec3 position{0.0};  ///< world, m
    glm::dvec3 flux{0.0};      ///< W, >= 0
    double radius = 0.0;       ///< of the disc, m
    std::uint32_t object = 0;  ///< Scene::objects
};

/// What measure_light() found.
struct MeasuredLight {
    LightStatistics statistics;
    double device_ms = 0.0;             ///< median over the repetitions; by timestamps, 0 where there are none
    double wall_ms = 0.0;               ///< likewise, by the clock: recording, submitting and waiting
    double voxel = 0.0;                 ///< edge of the smallest voxel, m
    std::vector<LandedPhoton> photons;  ///< in no order
};

/// Traces the lights of a scene through its volumes on a device of its own: once to compile and to upload, then
/// `repetitions` times (>= 1) with the clock. Throws Error if the device lacks
/// memory, or 64-bit atomics for KeptLight::kBrightest.
PELLUCID_API MeasuredLight measure_light(const DeviceOptions& device, const Scene& scene, const LightSettings& settings,
                                         int repetitions);

}  // namespace pellucid
