// Technique oliveira-brauwers-2007 against analytic answers, and on whatever mesh there is.
#include "gpu/exact_sphere.h"

#include <algorithm>
#include <filesystem>

namespace pellucid::test {
namespace {

constexpr double kIor = 1.5;

class OliveiraBrauwers : public RendererTest {
protected:
    static RenderSettings settings_for(std::uint32_t size) {
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.technique = "oliveira-brauwers-2007";
        settings.paths = true;
        return settings;
    }
    RenderResult render(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
        renderer().set_scene(scene);
        renderer().set_camera(camera);
        renderer().set_environment(uniform_environment());
        return renderer().render(settings);
    }
    /// Every covered pixel has an interface and nothing is undefined.
    static void expect_whole(const RenderResult& result, const std::string& what) {
        EXPECT_TRUE(all_finite(result.radiance)) << what;
        std::uint64_t covered = 0;
        for (const RefractedPath& path : result.paths) {
            if (path.events == 0) continue;
            ++covered;
            ASSERT_TRUE(std::isfinite(path.position.x + path.position.y + path.position.z)) << what;
            ASSERT_NEAR(glm::length(path.direction), 1.0f, 1e-4f) << what;
            ASSERT_TRUE(std::isfinite(path.length_inside) && path.length_inside >= 0.0f) << what;
            ASSERT_LE(path.events, 2) << what;
        }
        EXPECT_EQ(covered, result.covered) << what;
        std::uint64_t with_status = 0;
        for (const std::uint64_t count : result.status) with_status += count;
        EXPECT_EQ(with_status, covered) << what;
    }
};

Camera framing(const Scene& scene, float azimuth_deg) {
    const float fov = 0.5235988f;
    return orbit_camera(scene_bounds(scene), azimuth_deg, 15.0f, framing_distance(fov, 0.7f), fov);
}

TEST_F(OliveiraBrauwers, SphereExitsWhereTheFormulaSays) {
    constexpr int kSize = 256;
    const Scene scene = load_scene("shape:sphere,segments=160");
    const Camera camera = framing(scene, 30.0f);
    for (const double back_face : {0.0, 1.0}) {
        RenderSettings settings = settings_for(kSize);
        settings.parameters["back-face"] = back_face;
        const RenderResult result = render(scene, camera, settings);
        int covered = 0, right = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
            const RefractedPath& path = result.paths[std::size_t(i)];
            if (path.events == 0) continue;
            const auto exact = through_unit_sphere(pixel_ray(camera, kSize, kSize, i % kSize, i / kSize), kIor);
            if (!exact) continue;
            ++covered;
            if (angle_deg(path.direction, exact->direction) > 1.0) continue;
            ++right;
            EXPECT_NEAR(path.length_inside, exact->length, 0.05);
            EXPECT_EQ(path.status, Status::kOk);
        }
        EXPECT_GT(covered, 20000);
        EXPECT_GE(double(right) / covered, 0.99);
    }
}

// The ray leaves a slab in its old direction, shifted sideways by t sin(i) (1 - cos(i) / sqrt(n^2 - sin^2(i))).
TEST_F(OliveiraBrauwers, SlabShiftsTheRaySideways) {
    constexpr int kSize = 65;
    const double angle = 0.6, thickness = 0.3;
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = 0.4f;
    camera.world_from_view = glm::rotate(glm::mat4(1.0f), float(angle), glm::vec3(0, 1, 0)) *
                             glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 10));
    const RenderResult result =
        render(load_scene("shape:slab,width=2,height=2,thickness=0.3"), camera, settings_for(kSize));
    const RefractedPath& path = result.paths[kSize * kSize / 2];
    const glm::dvec3 direction = -glm::dvec3(camera.world_from_view[2]);
    EXPECT_LT(angle_deg(path.direction, direction), 0.01);
    EXPECT_EQ(path.status, Status::kOk);
    EXPECT_EQ(path.events, 2);
    const double s = std::sin(angle);
    EXPECT_NEAR(glm::length(glm::cross(glm::dvec3(path.position), direction)),
                thickness * s * (1.0 - std::cos(angle) / std::sqrt(kIor * kIor - s * s)), 1e-3);
    EXPECT_NEAR(path.length_inside, thickness / std::sqrt(1.0 - s * s / (kIor * kIor)), 2e-3);
}

// A cube seen along its diagonal: rays that meet the neighbouring side are totally reflected there, and say so.
TEST_F(OliveiraBrauwers, TotalReflectionAtTheExitIsTheEventLimit) {
    const Scene scene = load_scene("shape:cube");
    const RenderResult result = render(scene, framing(scene, 45.0f), settings_for(96));
    std::uint64_t reflected = 0;
    for (const RefractedPath& path : result.paths) {
        EXPECT_EQ(path.reflections > 0, path.status == Status::kEventLimit);
        reflected += path.reflections > 0 ? 1 : 0;
    }
    EXPECT_GT(double(reflected), 0.2 * double(result.covered));
    EXPECT_EQ(result.status[std::size_t(Status::kEventLimit)], reflected);
}

// The default stands for the far side: behind a hollow ball's wall the first back face is that wall's.
TEST_F(OliveiraBrauwers, BackFaceChoosesTheFarSide) {
    const Scene scene = load_scene("shape:hollow-sphere");
    RenderSettings settings = settings_for(65);
    const auto length_in_the_middle = [&](double back_face) {
        settings.parameters["back-face"] = back_face;
        return render(scene, framing(scene, 0.0f), settings).paths[65 * 65 / 2].length_inside;
    };
    EXPECT_LT(length_in_the_middle(0.0), 1.0f);
    EXPECT_NEAR(length_in_the_middle(1.0), 2.0f, 0.02f);
}

TEST_F(OliveiraBrauwers, SameFrameTwiceIsTheSameBitForBit) {
    const Scene scene = load_scene("shape:knot");
    const RenderResult a = render(scene, framing(scene, 0.0f), settings_for(128));
    const RenderResult b = render(scene, framing(scene, 0.0f), settings_for(128));
    EXPECT_EQ(a.radiance.pixels, b.radiance.pixels);
    expect_whole(a, "knot");
}

TEST_F(OliveiraBrauwers, OpenAndInvertedMeshesAreWhole) {
    Scene open = load_scene("shape:sphere,segments=32");
    open.meshes[0].triangles.resize(open.meshes[0].triangles.size() / 2);
    Scene inverted = load_scene("shape:torus");
    for (glm::uvec3& t : inverted.meshes[0].triangles) std::swap(t.y, t.z);
    for (const float azimuth : {0.0f, 90.0f, 180.0f}) {
        for (const Scene* scene : {&open, &inverted}) {
            const RenderResult result = render(*scene, framing(*scene, azimuth), settings_for(96));
            expect_whole(result, scene->source);
            EXPECT_GT(result.status[std::size_t(Status::kMissingLayer)], 0u);
        }
    }
}

TEST_F(OliveiraBrauwers, EveryModelIsWhole) {
    const char* data = std::getenv("PELLUCID_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "PELLUCID_TEST_DATA is not set";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "models")) {
        const std::string kind = entry.path().extension().string();
        if (kind == ".obj" || kind == ".ply" || kind == ".off") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    ASSERT_FALSE(files.empty());
    for (const auto& file : files) {
        const Scene scene = load_scene(file.string());
        const RenderResult result = render(scene, framing(scene, 20.0f), settings_for(96));
        EXPECT_GT(result.covered, 100u) << file;
        expect_whole(result, file.string());
    }
}

}  // namespace
}  // namespace pellucid::test
