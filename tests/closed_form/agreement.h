#pragma once

// Comparison of the paths of a technique with closed forms, on pixels that triangles and silhouettes do not decide.
#include "closed_form/closed_form_scene.h"

#include <pellucid/refracted_path.h>

#include <span>
#include <string>
#include <vector>

namespace pellucid::test {

inline constexpr int kMaxEvents = 16;  ///< the default of the techniques

/// The closed form of every pixel of a square image.
struct Truth {
    int size = 0;  ///< pixels
    std::vector<closed_form::Path> paths;
    /// Not 0: rays shifted by 0.1 pixel meet the same media in the same order, and leave within a degree. A path of
    /// more than kMaxEvents is never stable.
    std::vector<char> stable;
};
Truth trace_closed_form(const closed_form::Scene& scene, const closed_form::View& view, int size);

struct Agreement {
    int stable = 0;  ///< stable pixels where the closed form or the technique meets glass
    int right = 0;   ///< of these, with the same numbers of events and reflections, and directions within a degree
    /// The first wrong pixels, with both paths.
    std::string wrong;
    double share() const { return stable > 0 ? double(right) / stable : 1.0; }
};
/// Whether transmittances must agree, too. Those of techniques that follow what is reflected do not where it carries too
/// little for that: its light goes on with what is refracted.
enum class Transmittance { kCounts, kIsFree };
Agreement agreement(const Truth& truth, std::span<const RefractedPath> paths,
                    Transmittance transmittance = Transmittance::kCounts);

/// One line: events, reflections, direction, transmittance, status.
std::string to_string(const RefractedPath& path);

}  // namespace pellucid::test
