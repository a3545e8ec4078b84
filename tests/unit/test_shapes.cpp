// Every shape is closed, oriented and smooth where it claims to be, at coarse and odd tessellations.

#include "scene/shapes.h"

#include <pellucid/error.h>

#include <gtest/gtest.h>

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

namespace pellucid {
namespace {

using Corner = std::tuple<float, float, float>;

Corner corner(const Mesh& mesh, unsigned index) {
    const glm::vec3 p = mesh.positions[index];
    return {p.x, p.y, p.z};
}

/// Vertices of equal position share an id.
std::vector<unsigned> welded_ids(const Mesh& mesh) {
    std::map<Corner, unsigned> ids;
    std::vector<unsigned> result;
    for (unsigned i = 0; i < mesh.positions.size(); ++i)
        result.push_back(ids.try_emplace(corner(mesh, i), unsigned(ids.size())).first->second);
    return result;
}

glm::dvec3 area_normal(const Mesh& mesh, glm::uvec3 t) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    return 0.5 * glm::cross(b - a, c - a);
}

double signed_volume(const Mesh& mesh) {
    double volume = 0.0;
    for (const glm::uvec3 t : mesh.triangles)
        volume += glm::dot(glm::dvec3(mesh.positions[t.x]), area_normal(mesh, t)) / 3.0;
    return volume;
}

/// Every directed edge occurs once, and its reverse once: closed and consistently wound.
void expect_closed(const Mesh& mesh) {
    const std::vector<unsigned> id = welded_ids(mesh);
    std::map<std::pair<unsigned, unsigned>, int> edges;
    for (const glm::uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) ++edges[{id[t[k]], id[t[(k + 1) % 3]]}];
    std::size_t bad_count = 0;
    for (const auto& [edge, count] : edges) {
        const auto reverse = edges.find({edge.second, edge.first});
        if (edge.first == edge.second || count != 1 || reverse == edges.end()) ++bad_count;
    }
    EXPECT_EQ(bad_count, 0u);
}

void expect_sound(const Mesh& mesh) {
    ASSERT_EQ(mesh.positions.size(), mesh.normals.size());
    ASSERT_FALSE(mesh.triangles.empty());
    double least_area = 1e30, least_agreement = 1.0, worst_length = 0.0;
    for (const glm::vec3 normal : mesh.normals)
        worst_length = std::max(worst_length, std::abs(double(glm::length(normal)) - 1.0));
    for (const glm::uvec3 t : mesh.triangles) {
        ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
        const glm::dvec3 normal = area_normal(mesh, t);
        least_area = std::min(least_area, glm::length(normal));
        for (int k = 0; k < 3; ++k)
            least_agreement =
                std::min(least_agreement, glm::dot(glm::normalize(normal), glm::dvec3(mesh.normals[t[k]])));
    }
    EXPECT_LT(worst_length, 1e-6);
    EXPECT_GT(least_area, 1e-9);
    EXPECT_GT(least_agreement, 0.0);  // no vertex normal points to the other side of its triangle
    EXPECT_GT(signed_volume(mesh), 0.0);
    expect_closed(mesh);
}

TEST(Shapes, EveryDefaultIsClosedAndNamed) {
    for (const ShapeInfo& info : shape_infos()) {
        SCOPED_TRACE(info.name);
        const Mesh mesh = load_shape(std::string(info.name));
        EXPECT_EQ(mesh.name, info.name);
        expect_sound(mesh);
        float farthest = 0.0f;
        for (const glm::vec3 p : mesh.positions) farthest = std::max(farthest, glm::length(p));
        EXPECT_GT(farthest, 0.8f);
        EXPECT_LT(farthest, 1.2f);
    }
}

TEST(Shapes, EveryTessellationIsClosed) {
    for (const char* spec : {"sphere,segments=1",
                             "sphere,segments=7,radius=0.01",
                             "cube,segments=5",
                             "slab,width=3,height=0.7,thickness=0.001,segments=3",
                             "torus,segments=3,sides=3",
                             "torus,segments=17,sides=5,radius=1,tube=0.4",
                             "infinity-ring,segments=60,sides=20",
                             "infinity-ring,segments=101,sides=7,tube=0.05,lift=3",
                             "knot,p=3,q=2",
                             "knot,p=5,q=7,tube=0.04,segments=1001,sides=9",
                             "knot,p=1,q=1,tube=0.1",
                             "goblet,segments=24,rings=60",
                             "goblet,segments=7,rings=40,wall=0.08",
                             "goblet,segments=64,rings=500,wall=0.008",
                             "bottle,segments=9,rings=64",
                             "bottle,segments=24,rings=200,grooves=8,wall=0.06",
                             "bottle,segments=64,rings=500,grooves=1,wall=0.008",
                             "vase,segments=7,rings=48",
                             "vase,segments=9,rings=48,wall=0.12,half=1",
                             "vase,segments=3,rings=97,wall=0.008,half=1",
                             "vase,segments=64,rings=500,wall=0.04,half=1",
                             "gem,facets=5,table=0.7",
                             "gem,facets=64,girdle=0.005",
                             "hollow-sphere,segments=3,inner=0.99",
                             "hollow-sphere,segments=11,inner=0.05"}) {
        SCOPED_TRACE(spec);
        expect_sound(load_shape(spec));
    }
}

TEST(Shapes, TriangleCountsOfThePaperAndOfTheDocs) {
    // Wang 2014, table 4.1.
    EXPECT_EQ(load_shape("sphere,segments=8").triangles.size(), 512u);
    EXPECT_EQ(load_shape("torus,segments=24,sides=12").triangles.size(), 576u);
    EXPECT_EQ(load_shape("infinity-ring,segments=60,sides=20").triangles.size(), 2400u);

    EXPECT_EQ(load_shape("cube,segments=4").triangles.size(), 12u * 16u);
    EXPECT_EQ(load_shape("goblet,segments=10,rings=60").triangles.size(), 2u * 10u * 59u);
    EXPECT_EQ(load_shape("gem,facets=8").triangles.size(), 14u * 8u - 2u);
    EXPECT_EQ(load_shape("hollow-sphere,segments=5").triangles.size(), 16u * 25u);
    EXPECT_GE(load_shape("sphere").triangles.size(), 20000u);
}

TEST(Shapes, VolumesConvergeToTheFormulas) {
    const double pi = std::numbers::pi;
    EXPECT_NEAR(signed_volume(load_shape("sphere,segments=128")), 4.0 / 3.0 * pi, 2e-3);
    EXPECT_NEAR(signed_volume(load_shape("hollow-sphere,segments=128,inner=0.5")), 4.0 / 3.0 * pi * (1.0 - 0.125),
                2e-3);
    EXPECT_NEAR(signed_volume(load_shape("torus,segments=400,sides=200")), 2.0 * pi * pi * 0.7 * 0.3 * 0.3, 1e-3);
    EXPECT_NEAR(signed_volume(load_shape("slab,width=2,height=3,thickness=0.5")), 3.0, 1e-6);
    // Pappus: a tube's volume is its section times the length of its curve, however it winds.
    EXPECT_NEAR(signed_volume(load_shape("infinity-ring,segments=1000,sides=200,tube=0.1,lift=1.05")),
                pi * 0.01 * 4.74105, 2e-4);
}

TEST(Shapes, AnalyticNormalsAreExact) {
    const Mesh sphere = load_shape("sphere,segments=9,radius=2");
    for (std::size_t i = 0; i < sphere.positions.size(); ++i)
        EXPECT_LT(glm::length(sphere.positions[i] / 2.0f - sphere.normals[i]), 1e-6f);

    const Mesh hollow = load_shape("hollow-sphere,segments=9,inner=0.5");
    for (std::size_t i = 0; i < hollow.positions.size(); ++i) {
        const float distance = glm::length(hollow.positions[i]);
        const float outward = distance > 0.75f ? 1.0f : -1.0f;
        EXPECT_LT(glm::length(outward * hollow.positions[i] / distance - hollow.normals[i]), 1e-6f);
    }

    const Mesh torus = load_shape("torus,segments=31,sides=17,radius=1,tube=0.4");
    for (std::size_t i = 0; i < torus.positions.size(); ++i) {
        const glm::vec3 p = torus.positions[i];
        const glm::vec3 middle = glm::normalize(glm::vec3(p.x, p.y, 0.0f));
        EXPECT_LT(glm::length((p - middle) / 0.4f - torus.normals[i]), 2e-6f);
    }
}

TEST(Shapes, SmoothNormalsFollowTheSurface) {
    for (const char* spec : {"goblet,segments=600,rings=1500", "bottle,segments=600,rings=2000",
                             "knot,segments=2400,sides=300", "infinity-ring,segments=1600,sides=300"}) {
        SCOPED_TRACE(spec);
        const Mesh mesh = load_shape(spec);
        double least = 1.0;
        for (const glm::uvec3 t : mesh.triangles) {
            const glm::dvec3 normal = area_normal(mesh, t);
            const glm::dvec3 mean =
                glm::dvec3(mesh.normals[t.x]) + glm::dvec3(mesh.normals[t.y]) + glm::dvec3(mesh.normals[t.z]);
            least = std::min(least, glm::dot(glm::normalize(normal), glm::normalize(mean)));
        }
        EXPECT_GT(least, std::cos(0.02));
    }
}

TEST(Shapes, GemIsConvexWithFlatFacets) {
    for (const char* spec : {"gem", "gem,facets=5,table=0.7", "gem,facets=64,table=0.3",
                             "gem,facets=6,crown_deg=60,pavilion_deg=20,girdle=0.2"}) {
        SCOPED_TRACE(spec);
        const Mesh mesh = load_shape(spec);
        float farthest_out = -1.0f, worst_normal = 0.0f;
        for (const glm::uvec3 t : mesh.triangles) {
            const glm::vec3 normal = mesh.normals[t.x];
            for (const glm::vec3 p : mesh.positions)
                farthest_out = std::max(farthest_out, glm::dot(normal, p - mesh.positions[t.x]));
            const glm::vec3 flat(glm::normalize(area_normal(mesh, t)));
            for (int k = 0; k < 3; ++k) worst_normal = std::max(worst_normal, glm::length(flat - mesh.normals[t[k]]));
        }
        EXPECT_LT(farthest_out, 1e-6f);
        EXPECT_LT(worst_normal, 5e-5f);
    }
}

/// Whether segments a-b and c-d cross.
bool cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d) {
    const auto side = [](glm::dvec2 p, glm::dvec2 q, glm::dvec2 r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

/// Distance from the axis and height, from the middle of the underside to that of the bottom inside.
std::vector<glm::dvec2> profile_of(const std::string& spec) {
    // Three segments: the first vertex of each ring lies in the half plane z = 0, x > 0.
    std::vector<glm::dvec2> profile;
    for (const glm::vec3 p : load_shape(spec + ",segments=3").positions)
        if (p.z == 0.0f && p.x >= 0.0f) profile.emplace_back(p.x, p.y);
    return profile;
}

/// Pairs of segments that are no neighbours and cross.
int crossings(const std::vector<glm::dvec2>& profile) {
    int count = 0;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
        for (std::size_t j = i + 2; j + 1 < profile.size(); ++j)
            count += cross(profile[i], profile[i + 1], profile[j], profile[j + 1]);
    return count;
}

TEST(Shapes, BottleIsHollowAndOpen) {
    for (const char* wall : {"0.008", "0.03", "0.06"}) {
        SCOPED_TRACE(wall);
        const std::vector<glm::dvec2> profile = profile_of("bottle,rings=800,grooves=8,wall=" + std::string(wall));
        ASSERT_EQ(profile.size(), 801u);
        EXPECT_EQ(crossings(profile), 0);
        const auto rim = std::ranges::max_element(profile, {}, &glm::dvec2::y);
        // The inside goes down from the rim to the bottom, and is never nearer to the outside than most of a wall.
        const double thickness = std::stod(wall);
        EXPECT_NEAR(profile.back().y - profile.front().y, thickness, 0.1 * thickness);
        double thinnest = 1.0;
        for (auto inner = rim; inner != profile.end(); ++inner) {
            if (inner->y > rim->y - 2.0 * thickness) continue;  // around the rim itself
            for (auto outer = profile.begin(); outer != rim; ++outer)
                thinnest = std::min(thinnest, glm::distance(*inner, *outer));
        }
        EXPECT_GT(thinnest, 0.6 * thickness);
        EXPECT_GT(rim->x, 0.05);
    }
}

TEST(Shapes, HalfAVaseLiesBehindItsSections) {
    const Mesh half = load_shape("vase,segments=64,half=1"), whole = load_shape("vase,segments=128");
    EXPECT_NEAR(signed_volume(half), 0.5 * signed_volume(whole), 1e-5);
    for (const glm::vec3 position : half.positions) EXPECT_LE(position.z, 0.0f);
}

TEST(Shapes, VaseProfileDoesNotCrossItself) {
    for (const char* wall : {"0.008", "0.04", "0.12"}) {
        SCOPED_TRACE(wall);
        const std::vector<glm::dvec2> profile = profile_of("vase,rings=400,wall=" + std::string(wall));
        ASSERT_EQ(profile.size(), 401u);
        EXPECT_EQ(crossings(profile), 0);
        EXPECT_NEAR(profile.back().y - profile.front().y, std::stod(wall), 1e-3);
    }
}

TEST(Shapes, GobletProfileDoesNotCrossItself) {
    for (const char* wall : {"0.008", "0.02", "0.035", "0.08"}) {
        SCOPED_TRACE(wall);
        const std::vector<glm::dvec2> profile = profile_of("goblet,rings=400,wall=" + std::string(wall));
        ASSERT_EQ(profile.size(), 401u);
        EXPECT_EQ(crossings(profile), 0);
        // The inside of the bowl ends above the stem, on the axis.
        EXPECT_GT(profile.back().y, -0.12);
        EXPECT_EQ(profile.back().x, 0.0);
        EXPECT_EQ(profile.front().x, 0.0);
    }
}

TEST(Shapes, TubesKeepClearOfThemselves) {
    EXPECT_THROW(load_shape("knot,tube=0.25"), Error);
    EXPECT_THROW(load_shape("knot,p=12,q=11,tube=0.14"), Error);
    EXPECT_NO_THROW(load_shape("infinity-ring,tube=0.2,lift=1.05"));
    EXPECT_NO_THROW(load_shape("infinity-ring,tube=0.01,lift=3"));
}

/// The message of the Error that load_shape throws, or nothing.
std::string complaint(const std::string& spec) {
    try {
        load_shape(spec);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(Shapes, BadSpecificationsAreRefusedInOneLine) {
    for (const char* spec : {"",
                             "x",
                             "torus,",
                             "torus,,",
                             "torus,segments",
                             "torus,segments=",
                             "torus,=4",
                             "torus,segments=abc",
                             "torus,segments=4x",
                             "torus,segments=nan",
                             "torus,segments=inf",
                             "torus,segments=-inf",
                             "torus,segments=1e999",
                             "torus,segments=2",
                             "torus,segments=3001",
                             "torus,segments=12.5",
                             "torus,segments=12,segments=12",
                             "torus,sgments=12",
                             "torus,segments =12",
                             "torus,radius=0.3,tube=0.3",
                             "Torus",
                             "torus\n",
                             "\n\n",
                             "sphere,segments=1e9",
                             "knot,p=2,q=4",
                             "knot,p=2.5",
                             "goblet,wall=0.5",
                             "bottle,grooves=2.5"}) {
        const std::string message = complaint(spec);
        EXPECT_FALSE(message.empty()) << spec;
        EXPECT_EQ(message.find('\n'), std::string::npos) << spec;
    }
    EXPECT_NE(complaint("x").find("infinity-ring"), std::string::npos);
    EXPECT_NE(complaint("torus,x=1").find("segments, sides, radius, tube"), std::string::npos);
    EXPECT_NE(complaint("torus,sides=2").find("3 to 3000"), std::string::npos);
}

TEST(Shapes, DefaultsLieInTheirRanges) {
    for (const ShapeInfo& info : shape_infos())
        for (const ShapeParameter& parameter : info.parameters) {
            EXPECT_LE(parameter.minimum, parameter.default_value) << info.name;
            EXPECT_GE(parameter.maximum, parameter.default_value) << info.name;
        }
}

}  // namespace
}  // namespace pellucid
