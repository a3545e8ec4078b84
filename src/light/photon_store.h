#pragma once

#include "gpu/counted_buffer.h"
#include "gpu/frame.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace pellucid {

/// Light where it ends on an opaque surface, after glass or metal has bent its path; twin in photons.glsl.
struct Photon {
    glm::vec3 position;    ///< m, world
    float radius;          ///< m, of its kernel
    glm::vec3 flux;        ///< W
    std::uint32_t normal;  ///< of the surface, on the side that the photon came from; packed
    std::uint32_t level;   ///< of the grid; kStraightPhoton: not in the grid
    std::uint32_t object;  ///< it landed on; PELLUCID_NO_TRIANGLE: it left the scene; kNotYetLanded: as it was sent
    std::uint32_t texel;   ///< of the light's view that sent it: no two photons that landed share one
    std::uint32_t way;     ///< direction of travel, packed; the lowest bit: facets do not reflect it
};
static_assert(sizeof(Photon) == 48);
inline constexpr std::uint32_t kStraightPhoton = ~0u, kNotYetLanded = ~1u;
/// Bytes before the first in a list, whose first word counts them.
inline constexpr std::size_t kPhotonListHeader = 16;

/// Sizes by which photons are sorted and counted.
struct PhotonScale {
    float least_radius;        ///< m, of kernels
    float most_flux;           ///< W, of a photon as the light sends it
    std::uint32_t sample = 0;  ///< that draws what crowded slots keep
};

/// Photons in a hashed grid that the device builds. Two builds of the same photons give the same look-ups, bit for bit,
/// whatever the order of the photons. Its buffers live in the workspace, which holds those of one store.
class PhotonStore {
public:
    explicit PhotonStore(const Device& device);

    /// An empty list for a shader to append to ("Photons"), for `guess` photons where no capacity is known.
    const Buffer& begin(Recorder& recorder, Workspace& workspace, std::uint64_t guess);
    /// Sorts the photons of the list into the grid.
    void build(Recorder& recorder, Workspace& workspace, const PhotonScale& scale);
    /// As CountedBuffer::grow().
    bool grow();
    /// Photons that the list holds; 0: none was begun.
    std::uint32_t capacity() const { return list_.capacity(); }
    /// After grow(): 1 if the device has room for what was counted; otherwise the share of it that has, and the capacities
    /// are then those of the device.
    double fit(const Device& device);
    /// By the names of photon_lookup.glsl; after build().
    const std::vector<Binding>& bindings() const { return bindings_; }
    const Buffer& photons() const { return *photons_; }

private:
    std::uint64_t most_photons(const Device& device) const;

    CountedBuffer list_, entries_;
    const Buffer* photons_ = nullptr;
    std::vector<Binding> bindings_;
};

/// What light/photon_lookup.glsl binds; where a frame has no photons, what stands for them.
std::vector<Binding> photon_bindings(const Frame& frame);

}  // namespace pellucid
