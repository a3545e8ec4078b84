// Layers against ray casting on the CPU, and the two builders against each other.
#include "layers/layers.h"
#include "render/camera_constants.h"

#include "gpu/device_test.h"
#include "unit/test_files.h"

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::test {
namespace {

struct HostLayers {
    std::vector<std::vector<float>> depth;
    std::vector<std::vector<std::uint32_t>> triangle;
    std::vector<std::vector<std::uint32_t>> normal;  // 0 where there is no surface
    bool operator==(const HostLayers&) const = default;
};

class LayersTest : public DeviceTest {
protected:
    void set_scene(const Scene& scene, vk::Extent2D extent, float azimuth_deg = 20.0f) {
        extent_ = extent;
        scene_.emplace(device(), scene);
        camera_ = orbit_camera(scene_->bounds, azimuth_deg, 15.0f, framing_distance(0.5236f, 0.8f), 0.5236f);
        gpu::FrameConstants values{};
        set_camera(values, camera_, extent.width, extent.height, {0.0f, 0.0f}, scene_->bounds,
                   scene_->refractive_corners);
        values.object_count = scene_->object_count;
        constants_.emplace(device(), "constants", sizeof(values), vk::BufferUsageFlagBits::eStorageBuffer, true);
        std::memcpy(constants_->mapped(), &values, sizeof(values));
    }
    const Camera& camera() const { return camera_; }

    HostLayers build(LayerBuilder builder, std::uint32_t count, FragmentPool pool = {},
                     float opaque = float(PELLUCID_EMPTY_DEPTH), bool hidden_by_opaque = true) {
        LayerSource source(pool);
        for (;;) {
            source.begin_frame(builder);
            const Opaque surfaces = opaque_surfaces(opaque);
            const Layers layers =
                source.build(recorder(), frame(), surfaces, {scene_->refractive, count, hidden_by_opaque});
            recorder().submit_and_wait();
            if (!source.must_repeat(frame())) return read(layers);
        }
    }
    HostLayers peel(std::uint32_t count, float opaque = float(PELLUCID_EMPTY_DEPTH)) {
        return build(LayerBuilder::kDepthPeeling, count, {}, opaque);
    }
    HostLayers single_pass(std::uint32_t count, FragmentPool pool = {}, float opaque = float(PELLUCID_EMPTY_DEPTH)) {
        return build(LayerBuilder::kSinglePass, count, pool, opaque);
    }

private:
    Frame frame() {
        return {workspace(), *scene_,
                *constants_, workspace().image("environment", vk::Format::eR32G32B32A32Sfloat, {1, 1}),
                0,           extent_};
    }
    Opaque opaque_surfaces(float depth) {
        const GpuImage& image = workspace().image("opaque depth", vk::Format::eR32Sfloat, extent_);
        recorder().clear(image, vk::ClearColorValue(std::array{depth, 0.0f, 0.0f, 0.0f}));
        return {workspace().image("opaque radiance", vk::Format::eR32G32B32A32Sfloat, extent_), image,
                workspace().image("opaque object", vk::Format::eR32Uint, extent_)};
    }
    HostLayers read(const Layers& layers) {
        HostLayers host;
        for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
            host.depth.push_back(read_back<float>(device(), layers.depth, layer));
            host.triangle.push_back(read_back<std::uint32_t>(device(), layers.triangle, layer));
            host.normal.push_back(read_back<std::uint32_t>(device(), layers.normal, layer));
            for (std::size_t i = 0; i < host.normal.back().size(); ++i) {
                if (host.triangle.back()[i] == PELLUCID_NO_TRIANGLE) host.normal.back()[i] = 0;
            }
        }
        return host;
    }

    vk::Extent2D extent_;
    std::optional<GpuScene> scene_;
    std::optional<Buffer> constants_;
    Camera camera_;
};

Scene glass_scene(std::vector<Mesh> meshes) {
    Scene scene;
    Material glass;
    glass.transmission = glass.thickness = 1.0f;
    scene.materials.push_back(glass);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        Object object;
        object.mesh = int(i);
        scene.objects.push_back(object);
    }
    scene.meshes = std::move(meshes);
    return scene;
}

std::size_t fragments(const HostLayers& layers) {
    std::size_t count = 0;
    for (const auto& layer : layers.depth)
        count += std::size_t(std::count_if(layer.begin(), layer.end(), [](float d) { return d < 1e29f; }));
    return count;
}

void expect_sorted(const HostLayers& layers) {
    for (std::size_t k = 1; k < layers.depth.size(); ++k) {
        for (std::size_t i = 0; i < layers.depth[k].size(); ++i)
            ASSERT_LE(layers.depth[k - 1][i], layers.depth[k][i]) << k << " " << i;
    }
}

struct Crossing {
    double depth;
    std::uint32_t triangle;
    bool back;
};

/// Every triangle that a ray crosses, nearest first (Moeller & Trumbore 1997, in double precision).
/// `ambiguous` is set where the ray comes within a thousandth of an edge.
std::vector<Crossing> cast_ray(const Mesh& mesh, const WorldRay& ray, glm::dvec3 forward, bool& ambiguous) {
    std::vector<Crossing> crossings;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]), b(mesh.positions[mesh.triangles[t].y]),
            c(mesh.positions[mesh.triangles[t].z]);
        const glm::dvec3 p = glm::cross(ray.direction, c - a);
        const double determinant = glm::dot(b - a, p);
        if (determinant == 0.0) continue;
        const double u = glm::dot(ray.origin - a, p) / determinant;
        const glm::dvec3 q = glm::cross(ray.origin - a, b - a);
        const double v = glm::dot(ray.direction, q) / determinant;
        const double inside = std::min({u, v, 1.0 - u - v});
        if (std::abs(inside) < 1e-3) ambiguous = true;
        if (inside < 0.0) continue;
        const double distance = glm::dot(c - a, q) / determinant;
        if (distance > 0.0)
            crossings.push_back({distance * glm::dot(ray.direction, forward), std::uint32_t(t), determinant < 0.0});
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.depth < b.depth; });
    return crossings;
}

TEST_F(LayersTest, AgreeWithRayCasting) {
    const int size = 48;
    const Scene scene = load_scene("shape:knot,segments=48,sides=8");
    set_scene(scene, {std::uint32_t(size), std::uint32_t(size)});
    const HostLayers layers = single_pass(12);
    const glm::dvec3 forward = -glm::dvec3(camera().world_from_view[2]);
    int compared = 0, crossed = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            bool ambiguous = false;
            const auto expected = cast_ray(scene.meshes[0], pixel_ray(camera(), size, size, x, y), forward, ambiguous);
            // On an edge the rasteriser's rule decides between neighbours.
            if (ambiguous || expected.size() > 12) continue;
            ++compared;
            const auto i = std::size_t(y * size + x);
            for (std::size_t k = 0; k < 12; ++k) {
                const std::uint32_t triangle = layers.triangle[k][i];
                if (k >= expected.size()) {
                    EXPECT_EQ(triangle, PELLUCID_NO_TRIANGLE) << x << "," << y << " layer " << k;
                    continue;
                }
                ++crossed;
                EXPECT_EQ(triangle & ~PELLUCID_BACK_FACE, expected[k].triangle) << x << "," << y << " layer " << k;
                EXPECT_EQ((triangle & PELLUCID_BACK_FACE) != 0, expected[k].back) << x << "," << y << " layer " << k;
                // Rasterised depth is interpolated in single precision.
                EXPECT_NEAR(layers.depth[k][i], expected[k].depth, 2e-5 * expected[k].depth)
                    << x << "," << y << " layer " << k;
            }
        }
    }
    EXPECT_GT(compared, size * size / 2);
    EXPECT_GT(crossed, 1000);
}

TEST_F(LayersTest, BuildersAgreeOnShapes) {
    for (const char* shape :
         {"shape:sphere", "shape:goblet", "shape:gem", "shape:hollow-sphere", "shape:infinity-ring"}) {
        set_scene(load_scene(shape), {131, 77});
        for (const std::uint32_t count : {1u, 2u, 5u, 11u}) {
            const HostLayers peeled = peel(count);
            EXPECT_TRUE(peeled == single_pass(count)) << shape << ", " << count << " layers";
            expect_sorted(peeled);
        }
        EXPECT_GT(fragments(peel(11)), 1000u) << shape;
    }
}

TEST_F(LayersTest, BuildersAgreeOnRealMeshes) {
    std::vector<std::string> files;
    if (!glmark2_folder().empty()) files.push_back(glmark2_folder() / "bunny.obj");
    if (!data_folder().empty()) {
        for (const char* model : {"cow.obj", "photon_dragon.obj", "teapot.obj", "horse.ply"}) {
            files.push_back(data_folder() / "models" / model);
        }
    }
    if (files.empty()) GTEST_SKIP() << "neither glmark2's models nor PELLUCID_TEST_DATA are there";
    for (const std::string& file : files) {
        set_scene(load_scene(file), {256, 256}, 200.0f);
        const HostLayers peeled = peel(14);
        EXPECT_TRUE(peeled == single_pass(14)) << file;
        EXPECT_GT(fragments(peeled), 10000u) << file;
        expect_sorted(peeled);
    }
}

TEST_F(LayersTest, PoolGrowsAndBandsChangeNothing) {
    set_scene(load_scene("shape:goblet"), {97, 61});
    const HostLayers expected = peel(9);
    EXPECT_TRUE(expected == single_pass(9, {.capacity = 16, .bands = 1}));
    EXPECT_TRUE(expected == single_pass(9, {.capacity = 16, .bands = 7}));
    EXPECT_TRUE(expected == single_pass(9, {.capacity = 100000, .bands = 61}));
    EXPECT_TRUE(expected == single_pass(9, {.capacity = 100000, .bands = 1000}));
}

// Peeling by depth alone would lose all but one of the surfaces that lie at one depth.
TEST_F(LayersTest, EqualDepthsAreAllKept) {
    const Mesh cube = load_scene("shape:cube").meshes[0];
    set_scene(glass_scene({cube, cube, cube}), {64, 64});
    const HostLayers peeled = peel(7);
    EXPECT_TRUE(peeled == single_pass(7));
    const std::size_t center = 32 * 64 + 32;
    EXPECT_EQ(peeled.depth[0][center], peeled.depth[2][center]);
    EXPECT_LT(peeled.depth[2][center], peeled.depth[3][center]);
    EXPECT_EQ(peeled.depth[3][center], peeled.depth[5][center]);
    EXPECT_EQ(peeled.triangle[6][center], PELLUCID_NO_TRIANGLE);
    EXPECT_EQ(peeled.triangle[1][center], peeled.triangle[0][center] + cube.triangles.size());
}

TEST_F(LayersTest, OpaqueSurfacesHideWhatLiesBehindThem) {
    set_scene(load_scene("shape:sphere"), {33, 33});
    const HostLayers all = peel(2);
    const float nearest = *std::min_element(all.depth[0].begin(), all.depth[0].end());
    const float behind_first = 0.5f * (all.depth[0][16 * 33 + 16] + all.depth[1][16 * 33 + 16]);
    EXPECT_EQ(fragments(peel(2, 0.9f * nearest)), 0u);
    EXPECT_EQ(fragments(single_pass(2, {}, 0.9f * nearest)), 0u);
    EXPECT_TRUE(all == peel(2, 10.0f * nearest));
    // Inside the sphere: pixels whose first surface is in front keep all their layers.
    const HostLayers cut = peel(2, behind_first);
    EXPECT_TRUE(cut == single_pass(2, {}, behind_first));
    EXPECT_EQ(cut.depth[1][16 * 33 + 16], all.depth[1][16 * 33 + 16]);
}

TEST_F(LayersTest, MirroredObjectsKeepTheirSides) {
    Scene scene = load_scene("shape:sphere");
    scene.objects[0].world_from_object[0][0] = -1.0f;
    set_scene(scene, {32, 32});
    const HostLayers layers = single_pass(2);
    EXPECT_EQ(layers.triangle[0][16 * 32 + 16] & PELLUCID_BACK_FACE, 0u);
    EXPECT_NE(layers.triangle[1][16 * 32 + 16] & PELLUCID_BACK_FACE, 0u);
}

}  // namespace
}  // namespace pellucid::test
