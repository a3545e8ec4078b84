// The room bake: distances through solids against analytic answers, and the cache.
#include "bake/bake_cache.h"
#include "bake/inward_distances.h"
#include "bake/sampled_distances.h"

#include "unit/test_files.h"
#include "unit/test_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pellucid::test {
namespace {

Mesh shape(const std::string& name) { return load_scene("shape:" + name).meshes.front(); }

TEST(Bake, InwardDistanceOfASphereIsItsDiameter) {
    const Mesh mesh = shape("sphere,segments=24");
    const float radius = glm::length(mesh.positions.front());
    for (const float distance : bake::inward_distances(mesh)) {
        // The far side is a facet, at most 1 - cos(pi / (2 * 24)) below the sphere.
        EXPECT_LE(distance, 2.0f * radius * 1.000001f);
        EXPECT_GE(distance, 1.99f * radius);
    }
}

TEST(Bake, InwardDistanceOfASlabIsItsExtentAlongTheNormal) {
    const Mesh mesh = shape("slab,width=2,height=3,thickness=0.25");
    const std::vector<float> distances = bake::inward_distances(mesh);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const glm::vec3 n = glm::abs(mesh.normals[i]);
        // Corners of the faces lie on edges of the solid: the ray runs along the side faces and leaves through the
        // opposite face, or at once through the side that it runs in.
        const float extent = n.z > 0.9f ? 0.25f : n.x > 0.9f ? 2.0f : 3.0f;
        EXPECT_NEAR(distances[i], extent, 1e-5f);
    }
}

TEST(Bake, InwardDistanceOfATorusIsTheTubesDiameter) {
    const Mesh mesh = shape("torus,tube=0.3,segments=96,sides=48");
    for (const float distance : bake::inward_distances(mesh)) EXPECT_NEAR(distance, 0.6f, 0.003f);
}

TEST(Bake, ATriangleBesideTheVertexIsNotMet) {
    // The vertices of a cube with normals that lean to the outside of the three faces around them: every triangle
    // there passes through the ray's origin, and the diagonal leads to the opposite corner.
    Mesh mesh = cube(2.0f);
    for (const glm::vec3 p : mesh.positions) mesh.normals.push_back(glm::normalize(p));
    for (const float distance : bake::inward_distances(mesh)) EXPECT_NEAR(distance, 2.0f * std::sqrt(3.0f), 1e-5f);
    // However near the far side is: the vertices of a sheet a millionth as thick as it is wide.
    Mesh thin = cube(1.0f);
    for (glm::vec3& p : thin.positions) p.z *= 1e-6f;
    thin.normals.clear();
    for (const glm::vec3 p : thin.positions) thin.normals.emplace_back(0.0f, 0.0f, p.z < 0.0f ? -1.0f : 1.0f);
    for (const float distance : bake::inward_distances(thin)) EXPECT_NEAR(distance, 1e-6f, 1e-9f);
}

/// A prism around an L: a square of side 4 about the Z axis without its quarter at +X, +Y. Vertex 9 is in the middle of
/// the edge that runs inwards, which lies on that axis.
Mesh l_prism() {
    Mesh mesh;
    const glm::vec2 outline[] = {{-2, -2}, {2, -2}, {2, 0}, {0, 0}, {0, 2}, {-2, 2}};
    for (const float z : {-1.0f, 0.0f, 1.0f}) {
        for (const glm::vec2 p : outline) mesh.positions.emplace_back(p, z);
    }
    mesh.normals.assign(mesh.positions.size(), glm::vec3(1, 0, 0));
    for (unsigned ring = 0; ring < 2; ++ring) {
        for (unsigned i = 0; i < 6; ++i) {
            const unsigned a = 6 * ring + i, b = 6 * ring + (i + 1) % 6;
            mesh.triangles.emplace_back(a, b, b + 6);
            mesh.triangles.emplace_back(a, b + 6, a + 6);
        }
    }
    for (const unsigned i : {4u, 5u, 0u, 1u}) {
        const unsigned next = (i + 1) % 6;
        mesh.triangles.emplace_back(3, next, i);
        mesh.triangles.emplace_back(3 + 12, i + 12, next + 12);
    }
    return mesh;
}

// Seen along this ray the face at y = 0 is left at the vertex itself, although the ray runs on inside.
TEST(Bake, AnEdgeThatRunsInwardsIsNotMet) {
    Mesh mesh = l_prism();
    mesh.normals[9] = glm::normalize(glm::vec3(1.0f, -0.2f, 0.0f));
    EXPECT_NEAR(bake::inward_distances(mesh)[9], std::sqrt(4.0f + 0.16f), 1e-5f);
}

TEST(Bake, VerticesThatAreSplitCountAsOnePlace) {
    Mesh mesh = shape("sphere,segments=16");
    const Mesh split = unwelded(mesh);
    const std::vector<float> joined = bake::inward_distances(mesh), apart = bake::inward_distances(split);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) EXPECT_EQ(apart[3 * t + std::size_t(k)], joined[mesh.triangles[t][k]]);
    }
}

TEST(Bake, WithoutAWayOutTheDistanceIsZero) {
    Mesh sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    sheet.triangles = {{0, 1, 2}};
    EXPECT_EQ(bake::inward_distances(sheet), std::vector<float>(3, 0.0f));
}

TEST(Bake, DoesNotDependOnThreadsAndReportsProgress) {
    const Mesh mesh = shape("knot");
    double last = 0.0;
    const auto listen = [&](double share) {
        EXPECT_GE(share, last);
        last = share;
    };
    EXPECT_EQ(bake::inward_distances(mesh, 1, listen), bake::inward_distances(mesh));
    EXPECT_EQ(last, 1.0);
}

TEST(Bake, SampledDistancesOfASphereAreItsChords) {
    constexpr std::uint32_t kSide = 8;
    const Mesh mesh = shape("sphere,segments=32");
    const float radius = bake::mesh_sphere(mesh).radius;
    const std::vector<float> distances = bake::sampled_distances(mesh, kSide);
    ASSERT_EQ(distances.size(), bake::sampled_distance_count(kSide));
    const auto direction = [](std::size_t texel) {  // octahedral.glsl, once more
        const float x = (float(texel % kSide) + 0.5f) / (0.5f * kSide) - 1.0f;
        const float y = (float(texel / kSide) + 0.5f) / (0.5f * kSide) - 1.0f;
        glm::vec3 n(x, y, 1.0f - std::abs(x) - std::abs(y));
        if (n.z < 0.0f) {
            n.x = std::copysign(1.0f - std::abs(y), x);
            n.y = std::copysign(1.0f - std::abs(x), y);
        }
        return glm::normalize(n);
    };
    std::size_t inwards = 0;
    for (std::size_t point = 0; point < kSide * kSide; ++point) {
        for (std::size_t d = 0; d < kSide * kSide; ++d) {
            const float cosine = -glm::dot(direction(point), direction(d));
            const float distance = distances[point * kSide * kSide + d];
            if (cosine > 0.1f) {
                ++inwards;
                EXPECT_NEAR(distance, 2.0f * radius * cosine, 0.02f * radius);
            } else if (cosine < -0.1f) {
                EXPECT_EQ(distance, bake::kNoDistance);
            }
        }
    }
    EXPECT_GT(inwards, kSide * kSide * kSide * kSide / 3);
}

class BakeCacheTest : public ::testing::Test {
protected:
    /// Values from a new cache over the same folder, as in another run; counts what is computed.
    std::vector<float> get(const Mesh& mesh, std::string_view name = "counting") {
        bake::BakeCache cache(folder_ / "cache");
        return *cache.get(mesh, {name, 3}, compute(), warnings_);
    }
    bake::BakeCache::Compute compute() {
        return [this] {
            ++computed_;
            return std::vector<float>{1.0f, 2.0f, 3.0f};
        };
    }
    std::filesystem::path file() { return bake::BakeCache(folder_ / "cache").file_of(mesh_, {"counting", 3}); }

    TemporaryFolder folder_;
    Mesh mesh_ = load_scene("shape:cube").meshes.front();
    std::vector<std::string> warnings_;
    int computed_ = 0;
};

TEST_F(BakeCacheTest, IsAskedOnceInMemoryAndOnDisk) {
    bake::BakeCache cache(folder_ / "cache");
    const auto first = cache.get(mesh_, {"counting", 3}, compute(), warnings_);
    EXPECT_EQ(cache.get(mesh_, {"counting", 3}, compute(), warnings_), first);
    EXPECT_EQ(get(mesh_), *first);
    EXPECT_EQ(computed_, 1);
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "cache"), {}), 1);  // no temporary is left
}

TEST_F(BakeCacheTest, TellsMeshesAndQuantitiesApart) {
    get(mesh_);
    Mesh moved = mesh_, turned = mesh_, turned_triangles = mesh_;
    moved.positions[3].x += 1e-6f;
    turned.normals[3] = -turned.normals[3];
    std::swap(turned_triangles.triangles[0].x, turned_triangles.triangles[0].y);
    for (const Mesh& mesh : {moved, turned, turned_triangles}) get(mesh);
    get(mesh_, "other");
    const std::uint32_t parameters[] = {7};
    bake::BakeCache(folder_ / "cache").get(mesh_, {"counting", 3, parameters}, compute(), warnings_);
    EXPECT_EQ(computed_, 6);
}

TEST_F(BakeCacheTest, DamagedFilesAreWrittenAnew) {
    const std::vector<float> right = get(mesh_);
    const std::string content = content_of(file());
    std::string flipped = content;
    flipped.back() = char(flipped.back() ^ 1);
    int expected = 1;
    for (const std::string& damaged : {std::string(), content.substr(0, content.size() - 1), content + "x", flipped,
                                       std::string(content.size(), 'x')}) {
        folder_.file("cache/" + file().filename().string(), damaged);
        EXPECT_EQ(get(mesh_), right);
        EXPECT_EQ(computed_, ++expected);
        EXPECT_EQ(content_of(file()), content);
    }
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(BakeCacheTest, AFolderThatCannotBeWrittenIsSaidOnce) {
    const std::string file = folder_.file("no-folder", "");  // a file stands where the folder should
    bake::BakeCache cache(file);
    const auto values = cache.get(mesh_, {"counting", 3}, compute(), warnings_);
    EXPECT_EQ(cache.get(mesh_, {"counting", 3}, compute(), warnings_), values);  // from memory
    cache.get(mesh_, {"other", 3}, compute(), warnings_);
    EXPECT_EQ(computed_, 2);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_EQ(warnings_.front().find('\n'), std::string::npos);
    EXPECT_NE(warnings_.front().find("no-folder"), std::string::npos);
}

TEST_F(BakeCacheTest, TheFolderComesFromTheEnvironment) {
    const auto saved = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value ? value : "");
    };
    const std::string own = saved("PELLUCID_CACHE_DIR"), caches = saved("XDG_CACHE_HOME"), home = saved("HOME");
    setenv("PELLUCID_CACHE_DIR", "/a", 1);
    setenv("XDG_CACHE_HOME", "/b", 1);
    setenv("HOME", "/c", 1);
    EXPECT_EQ(bake::default_cache_folder(), "/a");
    unsetenv("PELLUCID_CACHE_DIR");
    EXPECT_EQ(bake::default_cache_folder(), "/b/pellucid");
    setenv("XDG_CACHE_HOME", "relative", 1);  // which the XDG specification says to ignore
    EXPECT_EQ(bake::default_cache_folder(), "/c/.cache/pellucid");
    unsetenv("HOME");
    EXPECT_TRUE(bake::default_cache_folder().empty());
    for (const auto& [name, value] :
         {std::pair("PELLUCID_CACHE_DIR", own), {"XDG_CACHE_HOME", caches}, {"HOME", home}}) {
        if (value.empty())
            unsetenv(name);
        else
            setenv(name, value.c_str(), 1);
    }
}

}  // namespace
}  // namespace pellucid::test
