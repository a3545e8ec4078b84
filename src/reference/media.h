#pragma once

// The solids around a path, and which of them fills an overlap.
//
// A path counts, per solid, its entries minus its exits; it is inside where the count is above zero. Overlapping
// shells of one body thus act as one solid, and a shell with reversed winding cuts a hole. Where solids overlap, the
// solid of the highest precedence displaces the others (Schmidt & Budge, "Simple nested dielectrics in ray traced
// images", 2002).

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Colour channels as components of vectors.
inline constexpr int kRed = 0, kGreen = 1, kBlue = 2;

/// Index of refraction and absorption of a homogeneous medium.
struct Medium {
    glm::dvec3 ior{1.0};      ///< for red, green and blue light
    glm::dvec3 sigma_a{0.0};  ///< absorption coefficient, 1/m

    bool operator==(const Medium&) const = default;
    /// True if the index depends on colour.
    bool disperses() const { return ior[kRed] != ior[kBlue]; }
};

/// Indices of refraction for red, green and blue. `ior` is the index at the d line; `dispersion` is 20 / V_d as in
/// glTF's KHR_materials_dispersion. V_d = (n_d - 1) / (n_F - n_C) gives the spread between blue and red. The extension
/// ("Implementation") puts half of it on either side of green. No index falls below 1.
inline glm::dvec3 channel_iors(double ior, double dispersion) {
    const double spread = (ior - 1.0) * dispersion / 20.0;
    return {std::max(1.0, ior - 0.5 * spread), ior, ior + 0.5 * spread};
}

/// Transmitted share of light after `distance`, m (Beer-Lambert). Exactly 1 if the distance or the absorption is 0,
/// even if the other is infinite.
inline glm::dvec3 beer_lambert(const glm::dvec3& sigma_a, double distance) {
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c) {
        if (sigma_a[c] > 0.0 && distance > 0.0) left[c] = std::exp(-sigma_a[c] * distance);
    }
    return left;
}

/// The closed shells of a body, or its open ones, which have no inside of their own.
struct Solid {
    Medium medium;
    std::uint32_t precedence = 0;  ///< unique; the solid of the highest precedence fills an overlap
    bool closed = true;            ///< every ray enters it as often as it leaves it
};

/// Sense in which a ray crosses a triangle: entering against its outward normal, leaving along it.
enum class Sense : std::int8_t { kEntering = 1, kLeaving = -1 };

inline constexpr std::int32_t kAir = -1;  ///< index for no solid

/// The solids around a path. Copying into a used stack is cheap: it needs no allocation.
class MediumStack {
public:
    explicit MediumStack(std::span<const Solid> solids) : solids_(solids) {}

    /// Entries minus exits of `solid`.
    std::int32_t count(std::uint32_t solid) const {
        const auto entry = find(solid);
        return entry == entries_.end() ? 0 : entry->count;
    }

    /// Crosses a boundary of `solid`. An open surface has no count: its normal alone tells the side of the path.
    void cross(std::uint32_t solid, Sense sense) {
        const std::int32_t step = sense == Sense::kEntering ? 1 : -1;
        set(solid, solids_[solid].closed ? count(solid) + step : std::max(step, 0));
    }

    void set(std::uint32_t solid, std::int32_t count) {
        const auto entry = find(solid);
        if (entry == entries_.end()) {
            if (count != 0) entries_.push_back({solid, count});
        } else if (count != 0) {
            entries_[std::size_t(entry - entries_.begin())].count = count;
        } else {
            entries_.erase(entry);
        }
        find_top();
    }

    void clear() {
        entries_.clear();
        top_ = kAir;
    }

    /// The solid that fills the position; kAir outside all solids.
    std::int32_t solid() const { return top_; }

    /// The medium that fills the position.
    Medium medium() const { return top_ == kAir ? Medium{} : solids_[std::size_t(top_)].medium; }

    /// True inside a closed solid: a path from here must meet another surface.
    bool enclosed() const {
        return std::any_of(entries_.begin(), entries_.end(),
                           [&](const Entry& entry) { return entry.count > 0 && solids_[entry.solid].closed; });
    }

private:
    struct Entry {
        std::uint32_t solid;
        std::int32_t count;  ///< not 0
    };
    std::vector<Entry>::const_iterator find(std::uint32_t solid) const {
        return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.solid == solid; });
    }

    void find_top() {
        top_ = kAir;
        for (const Entry& entry : entries_) {
            if (entry.count <= 0) continue;
            if (top_ == kAir || solids_[entry.solid].precedence > solids_[std::size_t(top_)].precedence) {
                top_ = std::int32_t(entry.solid);
            }
        }
    }

    std::span<const Solid> solids_;
    std::vector<Entry> entries_;
    std::int32_t top_ = kAir;
};

/// True if two media meet. Equal media of two touching solids have no interface.
inline bool is_interface(const MediumStack& inside, const MediumStack& beyond) {
    if (inside.solid() == beyond.solid()) return false;
    return inside.solid() == kAir || beyond.solid() == kAir || !(inside.medium() == beyond.medium());
}

}  // namespace pellucid::reference
