#include "reference/photon_map.h"

#include <cmath>
#include <limits>
#include <utility>

namespace pellucid::reference {

PhotonMap::PhotonMap(std::vector<Photon> photons) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const Photon& photon : photons) {
        low = glm::min(low, photon.position);
        high = glm::max(high, photon.position);
        radius_ = std::max(radius_, double(photon.radius));
    }
    if (photons.empty()) low = high = glm::dvec3(0.0);
    const glm::dvec3 extent = high - low;
    const double coarsest = std::max({extent.x, extent.y, extent.z}) / double((1 << kBits) - 1);
    low_ = low;
    cell_size_ = std::max({2.0 * radius_, coarsest, std::numeric_limits<double>::min()});

    std::vector<std::pair<std::uint64_t, std::size_t>> order;
    order.reserve(photons.size());
    for (std::size_t i = 0; i < photons.size(); ++i) order.emplace_back(key_of(cell_of(photons[i].position)), i);
    std::sort(order.begin(), order.end());
    photons_.reserve(photons.size());
    keys_.reserve(photons.size());
    for (const auto& [key, index] : order) {
        photons_.push_back(photons[index]);
        keys_.push_back(key);
    }
}

double photon_radius(double first_radius, std::uint32_t round) {
    constexpr double kAlpha = 2.0 / 3.0;
    double share = 1.0;
    for (std::uint32_t i = 1; i <= round; ++i) share *= (i + kAlpha) / (i + 1.0);
    return first_radius * std::sqrt(share);
}

}  // namespace pellucid::reference
