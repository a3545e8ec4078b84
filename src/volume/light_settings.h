#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// What a voxel keeps of the light that passes it.
enum class KeptLight {
    kSum,        ///< all of it, and its mean way (ours)
    kBrightest,  ///< the patch of greatest irradiance and its way, as in the paper; needs 64-bit atomics
};

/// How light is traced through volumes. Ihrke et al. 2007, section 4.2.
struct LightSettings {
    KeptLight kept = KeptLight::kSum;
    float step = 0.5f;         ///< optical length of a step, voxels, > 0
    float span = 1.0f;         ///< patches with a longer side are split, voxels, > 0
    float finest = 1.0f / 32;  ///< share of its first power below which a patch is not split any more, 0..1
    float weakest = 1e-6f;     ///< share of it below which a patch ends, 0..1
    float least_area = 0.02f;  ///< of a patch when its light is written, voxels^2: bounds what a focus is given
    bool keep_folds = true;    ///< false: a patch that has turned over ends there, as in the paper
    std::uint32_t capacity = 1u << 18;   ///< patches at once; at most what a storage buffer holds
    std::uint32_t steps_per_round = 16;  ///< of a patch before lists are compacted
    std::uint32_t slices =
        1;  ///< updates over which a light that moves is traced; until the last the one before is shown
    std::uint32_t rounds = 0;          ///< at most; 0: as many as light needs to cross all volumes one and a half times
    float texel = 1.0f;                ///< of receivers' maps, smallest voxels
    float reach = 3.0f;                ///< of receivers, radii of the sphere around all volumes
    std::uint32_t most_texels = 1024;  ///< along a side of a receiver
    bool fresnel = true;               ///< surfaces (Volume::boundary) reflect
    std::uint32_t reflections = 0;     ///< of light, one after another, that are followed, 0..7; others take it away
    float shown_spacing =
        0.0f;            ///< optical length between the wavefronts of View::kWavefront, smallest voxels; 0: none
    bool tally = false;  ///< kBrightest: count what voxels get from several directions (lit_voxels on); traces twice
};

/// What became of the light. Power in W, three colours.
struct LightStatistics {
    glm::dvec3 emitted{0.0};    ///< towards volumes
    glm::dvec3 arrived{0.0};    ///< on receivers
    glm::dvec3 missed{0.0};     ///< left the volumes and met none
    glm::dvec3 absorbed{0.0};   ///< or scattered
    glm::dvec3 reflected{0.0};  ///< at surfaces, and not followed
    glm::dvec3 turned{0.0};     ///< dropped at folds
    glm::dvec3 weak{0.0};       ///< dropped as too weak
    glm::dvec3 left{0.0};       ///< still on its way when the rounds ended
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
    /// What did not go as it should, a line each.
    std::vector<std::string> warnings() const;
};

}  // namespace pellucid
