// Layers against ray casting on the CPU, and the builders against each other.
#include "gpu/camera_constants.h"
#include "layers/layers.h"

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
        set_scene(scene, extent,
                  orbit_camera(scene_bounds(scene), azimuth_deg, 15.0f, framing_distance(0.5236f, 0.8f), 0.5236f));
    }
    void set_scene(const Scene& scene, vk::Extent2D extent, const Camera& camera) {
        extent_ = extent;
        scene_.emplace(device(), scene);
        camera_ = camera;
        view_ = {};
        gpu::FrameConstants& values = view_;
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
        return read(build_frame(source, builder, {{scene_->refractive, count, hidden_by_opaque}}, opaque).front());
    }
    /// As often as it takes; `drawn` says how often.
    std::vector<Layers> build_frame(LayerSource& source, LayerBuilder builder,
                                    const std::vector<LayerRequest>& requests,
                                    float opaque = float(PELLUCID_EMPTY_DEPTH), int* drawn = nullptr) {
        for (int frames = 1;; ++frames) {
            source.begin_frame(builder);
            opaque_.emplace(opaque_surfaces(opaque));
            std::vector<Layers> built;
            for (const LayerRequest& request : requests) {
                built.push_back(source.build(recorder(), frame(), *opaque_, request));
            }
            recorder().submit_and_wait();
            if (drawn) *drawn = frames;
            if (!source.must_repeat(frame())) return built;
        }
    }
    HostLayers dual_peel(std::uint32_t count, float opaque = float(PELLUCID_EMPTY_DEPTH),
                         bool hidden_by_opaque = true) {
        return build(LayerBuilder::kDualDepthPeeling, count, {}, opaque, hidden_by_opaque);
    }
    struct Effort {
        int frames;                     ///< drawn until one was right
        std::uint32_t geometry_passes;  ///< of the last
        bool operator==(const Effort&) const = default;
    };
    Effort effort(LayerSource& source, LayerBuilder builder, std::uint32_t count) {
        int frames = 0;
        build_frame(source, builder, {{scene_->refractive, count}}, float(PELLUCID_EMPTY_DEPTH), &frames);
        return {frames, source.geometry_passes()};
    }
    HostLayers peel(std::uint32_t count, float opaque = float(PELLUCID_EMPTY_DEPTH)) {
        return build(LayerBuilder::kDepthPeeling, count, {}, opaque);
    }
    HostLayers single_pass(std::uint32_t count, FragmentPool pool = {}, float opaque = float(PELLUCID_EMPTY_DEPTH)) {
        return build(LayerBuilder::kSinglePass, count, pool, opaque);
    }

    std::span<const DrawCall> solids() const { return scene_->refractive; }

    Frame frame() {
        const GpuImage& none = workspace().image("environment", vk::Format::eR32G32B32A32Sfloat, {1, 1});
        return {workspace(), *scene_, *constants_, view_, none, none, 0, extent_};
    }
    Opaque opaque_surfaces(float depth) {
        const GpuImage& image = workspace().image("opaque depth", vk::Format::eR32Sfloat, extent_);
        recorder().clear(image, vk::ClearColorValue(std::array{depth, 0.0f, 0.0f, 0.0f}));
        return {workspace().image("opaque radiance", vk::Format::eR32G32B32A32Sfloat, extent_), image,
                workspace().image("opaque object", vk::Format::eR32Uint, extent_),
                workspace().image("opaque triangle", vk::Format::eR32Uint, extent_)};
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

private:
    vk::Extent2D extent_;
    std::optional<Opaque> opaque_;
    gpu::FrameConstants view_{};
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

/// Depth at which a ray crosses the plane of a triangle.
double plane_depth(const Mesh& mesh, std::uint32_t triangle, const WorldRay& ray, glm::dvec3 forward) {
    const glm::uvec3 corners = mesh.triangles[triangle];
    const glm::dvec3 a(mesh.positions[corners.x]), b(mesh.positions[corners.y]), c(mesh.positions[corners.z]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    return glm::dot(a - ray.origin, normal) / glm::dot(ray.direction, normal) * glm::dot(ray.direction, forward);
}

TEST_F(LayersTest, AgreeWithRayCasting) {
    const int size = 48;
    // Rasterisers round corners to this fraction of a pixel.
    const double snap = std::exp2(-double(device().limits().subPixelPrecisionBits));
    const Scene scene = load_scene("shape:knot,segments=48,sides=8");
    set_scene(scene, {std::uint32_t(size), std::uint32_t(size)});
    const HostLayers drawn = single_pass(12), computed = build(LayerBuilder::kCompute, 12);
    const glm::dvec3 forward = -glm::dvec3(camera().world_from_view[2]);
    for (const HostLayers& layers : {drawn, computed}) {
        int compared = 0, crossed = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                bool ambiguous = false;
                const auto expected =
                    cast_ray(scene.meshes[0], pixel_ray(camera(), size, size, x, y), forward, ambiguous);
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
                    EXPECT_EQ((triangle & PELLUCID_BACK_FACE) != 0, expected[k].back)
                        << x << "," << y << " layer " << k;
                    // Depth is interpolated in single precision, between corners that have been rounded.
                    double rounding = 0.0;
                    for (const glm::dvec2 way : {glm::dvec2(snap, 0.0), glm::dvec2(0.0, snap)}) {
                        const WorldRay beside = pixel_ray(camera(), size, size, x + way.x, y + way.y);
                        const double depth = plane_depth(scene.meshes[0], expected[k].triangle, beside, forward);
                        rounding += std::abs(depth - expected[k].depth);
                    }
                    EXPECT_NEAR(layers.depth[k][i], expected[k].depth, 2e-5 * expected[k].depth + rounding)
                        << x << "," << y << " layer " << k;
                }
            }
        }
        EXPECT_GT(compared, size * size / 2);
        EXPECT_GT(crossed, 1000);
    }
}

TEST_F(LayersTest, BuildersAgreeOnShapes) {
    for (const char* shape :
         {"shape:sphere", "shape:goblet", "shape:gem", "shape:hollow-sphere", "shape:infinity-ring"}) {
        set_scene(load_scene(shape), {131, 77});
        for (const std::uint32_t count : {1u, 2u, 3u, 5u, 8u, 11u, 14u}) {
            const HostLayers peeled = peel(count);
            EXPECT_TRUE(peeled == single_pass(count)) << shape << ", " << count << " layers";
            EXPECT_TRUE(peeled == dual_peel(count)) << shape << ", " << count << " layers";
            expect_sorted(peeled);
        }
        EXPECT_GT(fragments(peel(11)), 1000u) << shape;
    }
}

/// Pixels whose triangles differ, layer by layer.
int different_pixels(const HostLayers& a, const HostLayers& b) {
    int different = 0;
    for (std::size_t i = 0; i < a.triangle.front().size(); ++i) {
        bool same = true;
        for (std::size_t k = 0; k < a.triangle.size(); ++k) same = same && a.triangle[k][i] == b.triangle[k][i];
        different += same ? 0 : 1;
    }
    return different;
}

// The rasteriser of the device rounds corners to 1/256 pixel or less, that of the compute shaders does not: they may differ
// at centres so close to an edge, one in a hundred or less here.
TEST_F(LayersTest, ComputedLayersAgreeButOnEdges) {
    for (const char* shape : {"shape:sphere", "shape:goblet", "shape:cube", "shape:slab", "shape:infinity-ring"}) {
        set_scene(load_scene(shape), {131, 77});
        for (const std::uint32_t count : {1u, 4u, 14u}) {
            const HostLayers drawn = single_pass(count), computed = build(LayerBuilder::kCompute, count);
            expect_sorted(computed);
            EXPECT_LE(different_pixels(drawn, computed), 131 * 77 / 100) << shape << ", " << count << " layers";
            EXPECT_TRUE(computed == build(LayerBuilder::kCompute, count)) << shape;
        }
    }
}

// Neighbours share no pixel centre and leave none out, also where large triangles are cut into tiles, where centres lie
// on edges, and where triangles reach behind the eye.
TEST_F(LayersTest, ComputedLayersHaveNoSeams) {
    Mesh grid;
    constexpr int kCells = 16;
    for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x) grid.positions.push_back({x - kCells / 2, y - kCells / 2, 0});
    for (unsigned y = 0; y < kCells; ++y) {
        for (unsigned x = 0; x < kCells; ++x) {
            const unsigned a = y * (kCells + 1) + x, b = a + 1, c = a + kCells + 1, d = c + 1;
            grid.triangles.push_back({a, b, d});
            grid.triangles.push_back({a, d, c});
        }
    }
    grid.normals.assign(grid.positions.size(), {0, 0, 1});
    const Scene scene = glass_scene({grid});
    for (const std::uint32_t size : {16u, 64u, 400u}) {
        for (const float tilt : {0.0f, 0.4f, 1.5f}) {
            Camera camera;
            camera.vertical_fov = 0.9f;
            camera.world_from_view = glm::rotate(glm::mat4(1.0f), tilt, glm::vec3(1, 0, 0)) *
                                     glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, tilt > 1.0f ? 1.0f : 6.0f));
            set_scene(scene, {size, size}, camera);
            const HostLayers layers = build(LayerBuilder::kCompute, 2);
            int covered = 0;
            for (std::size_t i = 0; i < layers.triangle[0].size(); ++i) {
                EXPECT_EQ(layers.triangle[1][i], PELLUCID_NO_TRIANGLE) << size << " " << tilt << ", pixel " << i;
                covered += layers.triangle[0][i] != PELLUCID_NO_TRIANGLE ? 1 : 0;
            }
            if (tilt < 1.0f) {
                EXPECT_EQ(covered, int(size * size)) << tilt;
            } else {
                EXPECT_GT(covered, int(size * size) / 4);
            }
        }
    }
}

TEST_F(LayersTest, BuildersAgreeOnRealMeshes) {
    std::vector<std::string> files;
    if (!glmark2_folder().empty()) files.push_back(glmark2_folder() / "bunny.obj");
    if (!data_folder().empty()) {
        for (const char* model :
             {"cow.obj", "photon_dragon.obj", "teapot.obj", "horse.ply", "bunny_closed_69664.obj"}) {
            files.push_back(data_folder() / "models" / model);
        }
    }
    if (files.empty()) GTEST_SKIP() << "neither glmark2's models nor PELLUCID_TEST_DATA are there";
    for (const std::string& file : files) {
        set_scene(load_scene(file), {256, 256}, 200.0f);
        const HostLayers peeled = peel(14);
        EXPECT_TRUE(peeled == single_pass(14)) << file;
        for (const std::uint32_t count : {3u, 4u, 8u, 14u}) {
            HostLayers nearest = peeled;
            for (auto* images : {&nearest.triangle, &nearest.normal}) images->resize(count);
            nearest.depth.resize(count);
            EXPECT_TRUE(nearest == dual_peel(count)) << file << ", " << count << " layers";
        }
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
    const HostLayers computed = build(LayerBuilder::kCompute, 9);
    EXPECT_TRUE(computed == build(LayerBuilder::kCompute, 9, {.capacity = 16, .bands = 1}));
    EXPECT_TRUE(computed == build(LayerBuilder::kCompute, 9, {.capacity = 16, .bands = 7}));
}

// Peeling by depth alone would lose all but one of the surfaces that lie at one depth.
TEST_F(LayersTest, EqualDepthsAreAllKept) {
    const Mesh cube = load_scene("shape:cube").meshes[0];
    set_scene(glass_scene({cube, cube, cube}), {64, 64});
    const HostLayers peeled = peel(7);
    EXPECT_TRUE(peeled == single_pass(7));
    EXPECT_TRUE(peeled == dual_peel(7));
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
    EXPECT_EQ(fragments(dual_peel(2, 0.9f * nearest)), 0u);
    EXPECT_TRUE(all == dual_peel(2, 0.9f * nearest, false));
    EXPECT_TRUE(cut == dual_peel(2, behind_first));
    const HostLayers partly = peel(2, 0.5f * (nearest + behind_first));
    EXPECT_TRUE(partly == dual_peel(2, 0.5f * (nearest + behind_first)));
    EXPECT_LT(fragments(partly), fragments(all));
    EXPECT_GT(fragments(partly), 0u);
    EXPECT_EQ(cut.depth[1][16 * 33 + 16], all.depth[1][16 * 33 + 16]);
}

TEST_F(LayersTest, MirroredObjectsKeepTheirSides) {
    Scene scene = load_scene("shape:sphere");
    scene.objects[0].world_from_object[0][0] = -1.0f;
    set_scene(scene, {32, 32});
    const HostLayers layers = single_pass(2), computed = build(LayerBuilder::kCompute, 2);
    for (const HostLayers& each : {layers, computed}) {
        EXPECT_EQ(each.triangle[0][16 * 32 + 16] & PELLUCID_BACK_FACE, 0u);
        EXPECT_NE(each.triangle[1][16 * 32 + 16] & PELLUCID_BACK_FACE, 0u);
    }
    EXPECT_TRUE(layers == dual_peel(2));
}

// Where a ray crosses an odd number of surfaces, one of them is the nearest and the farthest that is left.
TEST_F(LayersTest, OpenMeshesHaveNoSurfaceTwice) {
    Mesh half = load_scene("shape:knot,segments=48,sides=8").meshes[0];
    for (std::size_t i = 0; i < half.triangles.size() / 2; ++i) half.triangles[i] = half.triangles[2 * i];
    half.triangles.resize(half.triangles.size() / 2);  // every other one
    set_scene(glass_scene({half}), {90, 70});
    for (const std::uint32_t count : {1u, 2u, 3u, 4u, 9u}) {
        EXPECT_TRUE(peel(count) == dual_peel(count)) << count << " layers";
    }
    EXPECT_GT(fragments(peel(9)), 500u);
}

// Two surfaces at one depth are known by the lowest and the highest triangle, wherever the cut falls.
TEST_F(LayersTest, DoubleSurfacesNeedNoFallback) {
    const Mesh cube = load_scene("shape:cube").meshes[0];
    set_scene(glass_scene({cube, cube}), {64, 64});
    for (const std::uint32_t count : {1u, 2u, 3u, 4u, 5u}) {
        EXPECT_TRUE(peel(count) == dual_peel(count)) << count << " layers";
    }
    LayerSource source;
    EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, 4), (Effort{1, 3}));
}

TEST_F(LayersTest, TripleSurfacesArePeeledOneByOneFromThenOn) {
    const Mesh cube = load_scene("shape:cube").meshes[0];
    set_scene(glass_scene({cube, cube, cube}), {64, 64});
    LayerSource source;
    EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, 6), (Effort{2, 6}));
    EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, 6), (Effort{1, 6}));
}

/// Boxes one in another: view rays cross up to twice as many surfaces.
Scene nested_boxes(int boxes) {
    Scene scene = glass_scene(std::vector<Mesh>(std::size_t(boxes), load_scene("shape:cube").meshes[0]));
    for (int i = 0; i < boxes; ++i) {
        const float size = 1.0f - 0.8f * float(i) / float(boxes);
        scene.objects[std::size_t(i)].world_from_object = glm::mat4(glm::mat3(size));
    }
    return scene;
}

std::size_t most_surfaces(const HostLayers& layers) {
    std::size_t k = 0;
    const auto any = [](const std::vector<std::uint32_t>& triangles) {
        return std::any_of(triangles.begin(), triangles.end(), [](auto t) { return t != PELLUCID_NO_TRIANGLE; });
    };
    while (k < layers.triangle.size() && any(layers.triangle[k])) ++k;
    return k;
}

TEST_F(LayersTest, DualPeelingTakesHalfThePassesAndOne) {
    set_scene(nested_boxes(4), {64, 64});
    const std::size_t deepest = most_surfaces(peel(20));
    ASSERT_EQ(deepest, 8u);
    for (auto count = std::uint32_t(deepest); count < 20; ++count) {
        LayerSource source;
        EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, count), (Effort{1, (count + 1) / 2 + 1}));
        EXPECT_EQ(effort(source, LayerBuilder::kDepthPeeling, count), (Effort{1, count}));
        EXPECT_EQ(effort(source, LayerBuilder::kSinglePass, count).geometry_passes, 1u);
    }
}

// With fewer layers than surfaces the sides do not meet: one frame more finds out how many passes are needed.
TEST_F(LayersTest, DualPeelingLearnsHowManyPassesAreNeeded) {
    set_scene(nested_boxes(4), {64, 64});
    for (const auto& [count, peels] : {std::pair{6u, 4u}, {5u, 4u}, {4u, 4u}, {3u, 3u}}) {  // 8 surfaces: 4 peels do
        LayerSource source;
        EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, count), (Effort{2, count + 1}));
        EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, count), (Effort{1, peels + 1}));
        EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, count), (Effort{1, peels + 1}));
        EXPECT_TRUE(peel(count) == dual_peel(count));
    }
    LayerSource source;
    EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, 1), (Effort{1, 2}));
    EXPECT_EQ(effort(source, LayerBuilder::kDualDepthPeeling, 2), (Effort{2, 3}));
}

TEST_F(LayersTest, SeveralBuildsInAFrameKeepApart) {
    set_scene(nested_boxes(3), {64, 48});
    const std::vector<LayerRequest> requests = {{solids(), 4, true, "all"},
                                                {solids().subspan(0, 1), 2, false, "first"},
                                                {solids().subspan(1, 2), 3, false, "others"}};
    LayerSource lists, sides;
    std::vector<HostLayers> expected;
    for (const Layers& layers : build_frame(lists, LayerBuilder::kSinglePass, requests))
        expected.push_back(read(layers));
    for (int frame = 0; frame < 3; ++frame) {
        const std::vector<Layers> built = build_frame(sides, LayerBuilder::kDualDepthPeeling, requests);
        for (std::size_t i = 0; i < built.size(); ++i) {
            EXPECT_TRUE(expected[i] == read(built[i])) << requests[i].name << ", frame " << frame;
            EXPECT_GT(fragments(expected[i]), 100u) << requests[i].name;
        }
    }
}

}  // namespace
}  // namespace pellucid::test
