#pragma once

// Many random arrangements, traced by a technique and compared with their closed forms.
#include "closed_form/agreement.h"
#include "closed_form/arrangement.h"
#include "closed_form/solid_kinds.h"

#include <pellucid/scene.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace pellucid::test {

/// Paths of a square image of so many pixels.
using TraceArrangement = std::function<std::vector<RefractedPath>(const Scene&, const Camera&, std::uint32_t size)>;

/// How many arrangements a test tries: 50, or what the environment variable PELLUCID_ARRANGEMENTS says, 500 at most.
inline std::uint32_t arrangements_to_try() {
    const char* const wanted = std::getenv("PELLUCID_ARRANGEMENTS");
    return wanted ? std::uint32_t(std::clamp(std::atoi(wanted), 1, 500)) : 50u;
}

/// Right shares of arrangements whose seeds are spread over 0..499. A mean of 99.9% is asked for, and 99% where
/// 1,000 pixels or more are stable: balls are made of triangles (OneBallOfTrianglesIsABall measures what that costs).
inline void expect_agreement(const TraceArrangement& trace, std::uint32_t size,
                             Transmittance transmittance = Transmittance::kCounts) {
    const std::uint32_t tries = arrangements_to_try();
    double sum = 0.0, lowest = 1.0;
    std::uint32_t counted = 0;
    for (std::uint32_t i = 0; i < tries; ++i) {
        const std::uint32_t seed = i * 137 % 500;  // every fifth has one solid, with one shell
        const Arrangement arrangement = make_arrangement(seed);
        const Truth truth = trace_closed_form(closed_form_scene(arrangement), arrangement.view, int(size));
        const auto found_with = [&](int ball_levels) {
            return agreement(truth,
                             trace(solid_file(arrangement, ball_levels).load(), camera_of(arrangement.view), size),
                             transmittance);
        };
        Agreement found = found_with(5);
        if (found.share() < 0.99) found = found_with(6);  // many reflections in a ball: its triangles decide
        if (found.stable == 0) continue;
        sum += found.share();
        ++counted;
        if (found.stable < 1000) continue;
        lowest = std::min(lowest, found.share());
        EXPECT_GE(found.share(), 0.99) << describe(arrangement) << found.wrong;
    }
    ASSERT_GT(counted, tries / 2);
    EXPECT_GE(sum / counted, 0.999);
    fmt::print("{} arrangements: {:.3f}% right in the mean, {:.2f}% at least\n", counted, 100.0 * sum / counted,
               100.0 * lowest);
}

/// The same of every scene of solid_kinds(): 99.9% of the stable pixels.
inline void expect_agreement_on_kinds(const TraceArrangement& trace, std::uint32_t size) {
    for (const SolidKind& kind : solid_kinds()) {
        const Truth truth = trace_closed_form(closed_form_scene(kind.arrangement), kind.arrangement.view, int(size));
        const Scene scene = solid_file(kind.arrangement, 6).load();
        const Agreement found = agreement(truth, trace(scene, camera_of(kind.arrangement.view), size));
        EXPECT_GT(found.stable, 30) << kind.name;
        EXPECT_GE(found.share(), 0.999) << kind.name << "\n" << describe(kind.arrangement) << found.wrong;
    }
}

}  // namespace pellucid::test
