#pragma once

// Which solids a path is in, and which of them fills the space where they overlap.
//
// A path counts, per solid, the boundaries it has entered less those it has left; it is inside where
// the count is above zero. Overlapping shells of one body so count as one solid, and a shell with
// reversed winding cuts a hole. Where solids overlap, the one of the highest precedence displaces the
// others (Schmidt & Budge, "Simple nested dielectrics in ray traced images", 2002).

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid::reference {

/// Colour channels as components of vectors.
inline constexpr int kRed = 0, kGreen = 1, kBlue = 2;

/// Index of refraction and absorption of what fills a place.
struct Medium {
    glm::dvec3 ior{1.0};      ///< for red, green and blue light
    glm::dvec3 sigma_a{0.0};  ///< absorption coefficient, 1/m

    bool operator==(const Medium&) const = default;
    /// True if colours part at its boundary.
    bool disperses() const { return ior[kRed] != ior[kBlue]; }
};

/// Indices of refraction for red, green and blue: `ior` is that at the d line, `dispersion` 20 / V_d as glTF's
/// KHR_materials_dispersion has it. V_d = (n_d - 1) / (n_F - n_C) gives the spread between blue and red, half of
/// which the extension ("Implementation") puts on either side of green. No index falls below 1.
inline glm::dvec3 channel_iors(double ior, double dispersion) {
    const double spread = (ior - 1.0) * dispersion / 20.0;
    return {std::max(1.0, ior - 0.5 * spread), ior, ior + 0.5 * spread};
}

/// Share of the light that is left after a distance, m (Beer-Lambert). No way or no absorption leaves all of it,
/// whatever the other is.
inline glm::dvec3 beer_lambert(const glm::dvec3& sigma_a, double distance) {
    glm::dvec3 left(1.0);
    for (int c = 0; c < 3; ++c) {
        if (sigma_a[c] > 0.0 && distance > 0.0) left[c] = std::exp(-sigma_a[c] * distance);
    }
    return left;
}

/// The closed shells of a body, or its open ones: these have no inside of their own.
struct Solid {
    Medium medium;
    std::uint32_t precedence = 0;  ///< unique; where solids overlap the highest fills the space
    bool closed = true;            ///< every ray enters it as often as it leaves it
};

/// Sense in which a ray crosses a triangle: against its outward normal, or along it.
enum class Sense : std::int8_t { kEntering = 1, kLeaving = -1 };

inline constexpr std::int32_t kAir = -1;  ///< as a solid: none

/// The solids that a path is in. Cheap to copy into one that was used before: no allocation then.
class MediumStack {
public:
    explicit MediumStack(std::span<const Solid> solids) : solids_(solids) {}

    /// Boundaries of `solid` that were entered less those that were left.
    std::int32_t count(std::uint32_t solid) const {
        const auto entry = find(solid);
        return entry == entries_.end() ? 0 : entry->count;
    }

    /// Crosses a boundary of `solid`. A surface that is not closed has no count to keep: its normal
    /// alone says on which side the path now is.
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

    /// Solid that fills the place, kAir outside all of them.
    std::int32_t solid() const { return top_; }

    /// What fills the place.
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

/// True if two media meet there. Equal media of two solids that touch have no interface.
inline bool is_interface(const MediumStack& inside, const MediumStack& beyond) {
    if (inside.solid() == beyond.solid()) return false;
    return inside.solid() == kAir || beyond.solid() == kAir || !(inside.medium() == beyond.medium());
}

}  // namespace pellucid::reference
