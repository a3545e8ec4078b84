#pragma once

#include "reference/geometry.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Light of a source at the first surface that is not smooth, after mirrors or refractions.
struct Photon {
    glm::dvec3 position{0.0};   ///< world, m
    glm::vec3 normal{0.0f};     ///< unit, outward, of the triangle
    glm::vec3 direction{0.0f};  ///< unit, direction of travel
    glm::vec3 flux{0.0f};       ///< W, RGB, over n^2 of the medium in which it arrives (as radiance in bsdf.h)
    float share = 1.0f;         ///< 1 / n^2, the factor contained in `flux`
    Crossing crossing{};        ///< crossing of the triangle
    float radius = 0.0f;        ///< m, radius of the look-up disc
    float area = 0.0f;          ///< m2, area of the receiver inside the disc
};

/// True if surfaces with these unit normals count as one receiver.
inline bool of_one_surface(const glm::dvec3& normal, const glm::dvec3& other) { return glm::dot(normal, other) > 0.5; }

/// Photons of one round, with look-ups around a point (Jensen, "Global illumination using photon maps", 1996). A
/// sorted grid makes their order depend only on their positions and input order.
class PhotonMap {
public:
    PhotonMap() = default;
    /// The photons must have their radii.
    explicit PhotonMap(std::vector<Photon> photons);

    const std::vector<Photon>& photons() const { return photons_; }

    /// Calls visit(photon) for each photon within its own radius of `position`, on a surface with a similar unit
    /// normal.
    template <class Visit>
    void for_each_near(const glm::dvec3& position, const glm::dvec3& normal, const Visit& visit) const {
        const Cell low = cell_of(position - radius_), high = cell_of(position + radius_);
        for (std::uint64_t z = low.z; z <= high.z; ++z) {
            for (std::uint64_t y = low.y; y <= high.y; ++y) {
                const auto first = std::lower_bound(keys_.begin(), keys_.end(), key_of({low.x, y, z}));
                const auto end = std::upper_bound(first, keys_.end(), key_of({high.x, y, z}));
                for (auto key = first; key != end; ++key) {
                    const Photon& photon = photons_[std::size_t(key - keys_.begin())];
                    if (belongs(photon, position, normal)) visit(photon);
                }
            }
        }
    }

private:
    using Cell = glm::u64vec3;
    static constexpr int kBits = 21;  // bits of a cell's coordinate along each axis

    Cell cell_of(const glm::dvec3& position) const {
        return glm::clamp((position - low_) / cell_size_, 0.0, double((1 << kBits) - 1));
    }
    /// Key of a cell. Neighbours along x have consecutive keys.
    static std::uint64_t key_of(const Cell& cell) { return (cell.z << 2 * kBits) | (cell.y << kBits) | cell.x; }
    bool belongs(const Photon& photon, const glm::dvec3& position, const glm::dvec3& normal) const {
        const glm::dvec3 apart = photon.position - position;
        return glm::dot(apart, apart) <= double(photon.radius) * double(photon.radius) &&
               of_one_surface(glm::dvec3(photon.normal), normal);
    }

    std::vector<Photon> photons_;      ///< sorted by key
    std::vector<std::uint64_t> keys_;  ///< keys of the photons' cells, ascending
    double radius_ = 0.0;              ///< m, largest radius of the photons
    double cell_size_ = 1.0;
    glm::dvec3 low_{0.0};
};

/// Look-up radius, m, in round `round` (from 0). Its square shrinks by Knaus & Zwicker, "Progressive photon mapping: a
/// probabilistic approach", 2011, equation 15, with alpha = 2/3. The mean over the rounds then converges in bias and
/// in variance.
double photon_radius(double first_radius, std::uint32_t round);

}  // namespace pellucid::reference
