// The random arrangements themselves: what they contain, and that their files mean the same as their closed forms.
#include "closed_form/agreement.h"
#include "closed_form/arrangement.h"

#include <pellucid/reference.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSeeds = 500;
constexpr std::uint32_t kSize = 64;

Agreement traced(const Arrangement& arrangement) {
    const Scene scene = solid_file(arrangement).load();
    const ExactSettings settings{.width = kSize, .height = kSize};
    const Truth truth = trace_closed_form(closed_form_scene(arrangement), arrangement.view, kSize);
    return agreement(truth, Tracer(scene).exact(camera_of(arrangement.view), settings));
}

TEST(ArrangementPlans, AreTheSameEveryTime) {
    for (const std::uint32_t seed : {1u, 17u, 499u})
        EXPECT_EQ(describe(make_arrangement(seed)), describe(make_arrangement(seed)));
    EXPECT_NE(describe(make_arrangement(1)).substr(14), describe(make_arrangement(2)).substr(14));
}

TEST(ArrangementPlans, ContainEveryKind) {
    std::map<std::string, int> kinds;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const Arrangement arrangement = make_arrangement(seed);
        ASSERT_GE(arrangement.solids.size(), 1u);
        ASSERT_LE(arrangement.solids.size(), 7u);
        const closed_form::Scene scene = closed_form_scene(arrangement);
        kinds["orthographic"] += arrangement.view.orthographic;
        kinds["eye inside"] += scene.body_at(glm::dvec3(arrangement.view.world_from_view[3])) >= 0;
        for (const PlannedSolid& s : arrangement.solids) {
            ++kinds[s.story.substr(0, s.story.find(','))];
            kinds["again"] += s.story.find("same place") != std::string::npos;
            kinds["split"] += s.primitives > 1;
            kinds["mirrored"] += glm::determinant(glm::mat3(s.world_from_solid)) < 0.0f;
            kinds["double-sided"] += s.double_sided;
            kinds["miswound"] += s.miswound;
            kinds["priority"] += s.priority != 0;
            kinds["air"] += s.medium.ior == 1.0;
            for (const PlannedShell& shell : s.shells) {
                kinds["inside out"] += shell.written_inside_out;
                kinds["twice"] += shell.written_twice;
            }
        }
    }
    EXPECT_EQ(kinds.size(), 23u);
    for (const auto& [kind, count] : kinds) {
        EXPECT_GE(count, 15) << kind;
        RecordProperty(kind, count);
    }
}

TEST(ArrangementPlans, VolumesDecideWhichSolidWins) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const std::vector<PlannedSolid> solids = make_arrangement(seed).solids;
        for (std::size_t i = 0; i < solids.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                if (solids[i].priority != solids[j].priority) continue;
                const double a = solids[i].volume, b = solids[j].volume, apart = std::abs(a - b) / std::max(a, b);
                ASSERT_TRUE(apart < 1e-4 || apart > 0.019) << seed << ": " << a << " and " << b;
            }
    }
}

/// What triangles cost: the ball is fine enough to stand for the true one.
TEST(ArrangementPlans, OneBallOfTrianglesIsABall) {
    Arrangement arrangement;
    PlannedSolid ball;
    ball.shells.push_back({{closed_form::ShellKind::kBall, glm::dmat4(1.0), 1}});
    ball.medium = {1.5, {0.3, 0.2, 0.1}};
    ball.volume = closed_form::material_volume({ball.shells[0].shell});
    arrangement.solids = {ball};
    for (const double distance : {4.0, 1.5, 0.8}) {
        arrangement.view.world_from_view[3] = glm::dvec4(0.1, 0.2, distance, 1.0);
        const Agreement found = traced(arrangement);
        EXPECT_GE(found.stable, 800) << distance;
        EXPECT_GE(found.share(), 0.9995) << distance << "\n" << found.wrong;
    }
}

/// One shell outside the eye needs no rule about solids, so what differs would be the files or the closed forms.
TEST(ArrangementPlans, SingleSolidsWrittenPlainlyAgree) {
    int stable = 0;
    for (std::uint32_t seed = 0; seed < 200; seed += 5) {
        const Agreement found = traced(written_plainly(make_arrangement(seed)));
        EXPECT_GE(found.share(), 0.9995) << "seed " << seed << "\n" << found.wrong;
        stable += found.stable;
    }
    EXPECT_GT(stable, 30000);
}

}  // namespace
}  // namespace pellucid::test
