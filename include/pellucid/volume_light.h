#pragma once

#include <pellucid/api.h>
#include <pellucid/device.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Quantity that a voxel stores of the light passing it.
enum class KeptLight {
    kSum,        ///< the sum of all light, and its mean direction
    kBrightest,  ///< the brightest patch and its direction, as in the paper; needs 64-bit atomics
};

/// Settings of light tracing through volumes, as wavefronts of patches. Ihrke et al. 2007, "Eikonal Rendering",
/// section 4.2.
struct LightSettings {
    KeptLight kept = KeptLight::kSum;
    float step = 0.5f;         ///< optical length of a step, voxels, > 0
    float span = 1.0f;         ///< patches with a longer side are split; voxels, > 0
    float finest = 1.0f / 32;  ///< a patch below this share of its initial power is not split, 0..1
    float weakest = 1e-6f;     ///< a patch below this share of its initial power ends, 0..1
    /// least area of a patch when its light is written, voxels^2: limits irradiance at a focus
    float least_area = 0.02f;
    bool keep_folds = true;              ///< false: a patch that has folded over ends there, as in the paper
    std::uint32_t capacity = 1u << 18;   ///< most patches at once, limited by the size of a storage buffer
    std::uint32_t steps_per_round = 16;  ///< steps of a patch between compactions of the lists
    std::uint32_t slices =
        1;  ///< updates over which a moving light is traced; until the last, the previous result is shown
    std::uint32_t rounds = 0;       ///< most rounds; 0: enough for light to cross all volumes one and a half times
    float photon_spacing = 0.5f;    ///< spacing of photons where patches meet opaque surfaces, smallest voxels, > 0
    bool fresnel = true;            ///< surfaces (Volume::boundary) reflect light
    std::uint32_t reflections = 0;  ///< successive reflections followed, 0..7; light beyond them is lost
    float shown_spacing =
        0.0f;  ///< optical length between the wavefronts of View::kWavefront, smallest voxels; 0: none
    /// kBrightest: count light from several directions per voxel (from lit_voxels on); traces twice
    bool tally = false;
};

/// Energy balance of the light: power in W, for red, green and blue.
struct LightStatistics {
    glm::dvec3 emitted{0.0};    ///< towards volumes
    glm::dvec3 arrived{0.0};    ///< on opaque surfaces
    glm::dvec3 missed{0.0};     ///< left the volumes without meeting a surface
    glm::dvec3 absorbed{0.0};   ///< absorbed or scattered
    glm::dvec3 reflected{0.0};  ///< reflected at surfaces and not followed
    glm::dvec3 turned{0.0};     ///< dropped at folds
    glm::dvec3 weak{0.0};       ///< dropped as too weak
    glm::dvec3 left{0.0};       ///< still in flight when the rounds ended
    std::uint32_t patches = 0;  ///< most patches at once
    std::uint32_t splits = 0, rounds = 0;
    std::uint32_t refused = 0;               ///< splits and reflections beyond `capacity`
    std::uint32_t shown = 0, not_shown = 0;  ///< patches for View::kWavefront: kept, and beyond the capacity
    std::uint32_t patches_left = 0;          ///< patches alive when the rounds ended
    bool coarsened = false;                  ///< for lack of capacity, patches began larger than `span`
    bool coarse_voxels = false;      ///< for lack of memory, voxels of light are larger than those of their volume
    std::uint64_t lit_voxels = 0;    ///< tally: voxels with light
    std::uint64_t multi_voxels = 0;  ///< tally: lit voxels that get over 1% from directions other than the brightest
    double main_share = 1.0;  ///< share of the light in those voxels from within 15 degrees of the brightest direction
    /// Light that was dropped or coarsened, one line each.
    PELLUCID_API std::vector<std::string> warnings() const;
};

/// Light that arrived at an opaque surface. Look-ups spread it over a disc.
struct LandedPhoton {
    glm::dvec3 position{0.0};  ///< world, m
    glm::dvec3 flux{0.0};      ///< W, >= 0
    double radius = 0.0;       ///< radius of the disc, m
    std::uint32_t object = 0;  ///< index into Scene::objects
};

/// Result of measure_light().
struct MeasuredLight {
    LightStatistics statistics;
    double device_ms = 0.0;  ///< median over the repetitions, by timestamps; 0 without timestamps
    double wall_ms = 0.0;    ///< median over the repetitions, by the clock: recording, submitting and waiting
    double voxel = 0.0;      ///< edge of the smallest voxel, m
    std::vector<LandedPhoton> photons;  ///< in no particular order
};

/// Traces the lights of a scene through its volumes on a device of its own: once to compile and upload, then
/// `repetitions` times (>= 1) timed. Throws Error if the device lacks memory, or lacks 64-bit atomics for
/// KeptLight::kBrightest.
PELLUCID_API MeasuredLight measure_light(const DeviceOptions& device, const Scene& scene, const LightSettings& settings,
                                         int repetitions);

}  // namespace pellucid
