// Wyman 2005 against analytic answers.
#include "gpu/exact_sphere.h"

#include "unit/test_files.h"

#include <algorithm>
#include <set>

namespace pellucid::test {
namespace {

constexpr double kIor = 1.5;

RenderSettings settings_for(std::uint32_t size, ParameterMap parameters = {}) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.technique = "wyman-2005";
    settings.parameters = std::move(parameters);
    settings.paths = true;
    return settings;
}

/// Camera far away on +Z, seeing `extent` metres, all rays parallel and turned by `angle` about Y.
Camera parallel_camera(float angle, float extent) {
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = extent;
    camera.world_from_view =
        glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0, 1, 0)) * glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 10));
    return camera;
}

Camera framing(const Scene& scene, float azimuth_deg) {
    return orbit_camera(scene_bounds(scene), azimuth_deg, 15.0f, framing_distance(0.5235988f, 0.7f), 0.5235988f);
}

class Wyman2005 : public RendererTest {
protected:
    RenderResult render(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
        renderer().set_scene(scene);
        renderer().set_camera(camera);
        renderer().set_environment(uniform_environment());
        return renderer().render(settings);
    }
};

bool finite(const RefractedPath& path) {
    return std::isfinite(glm::dot(path.direction, path.position) + path.length_inside +
                         glm::dot(path.transmittance, glm::vec3(1.0f)));
}

// At normal incidence both distances are the slab's thickness. Tilted, d_N is the thickness and d_V is longer.
TEST_F(Wyman2005, ASlabIsExact) {
    constexpr std::uint32_t kSize = 33;
    const Scene scene = load_scene("shape:slab,width=2,height=2,thickness=0.3");
    for (const float angle : {0.0f, 0.4f}) {
        const Camera camera = parallel_camera(angle, 0.4f);
        const RenderResult result = render(scene, camera, settings_for(kSize));
        const glm::dvec3 direction = -glm::dvec3(camera.world_from_view[2]);
        const double sin_i = std::sin(double(angle)), cos_t = std::sqrt(1.0 - sin_i * sin_i / (kIor * kIor));
        for (std::size_t i = 0; i < result.paths.size(); ++i) {
            const RefractedPath& path = result.paths[i];
            ASSERT_EQ(path.events, 2);
            const std::size_t column = i % kSize;
            if (column < kSize / 4 || column >= kSize - kSize / 4) continue;  // there the exit is beside the picture
            EXPECT_EQ(path.status, Status::kOk);
            EXPECT_LT(angle_deg(path.direction, direction), 0.01);
            // Straight on it is exact. Tilted, the guess lies between the thickness and the way of the view ray.
            const double ratio = angle > 0.0f ? std::asin(sin_i / kIor) / double(angle) : 1.0 / kIor;
            const double guess = ratio * 0.3 / std::cos(double(angle)) + (1.0 - ratio) * 0.3;
            EXPECT_NEAR(path.length_inside, guess, 1e-4);
            EXPECT_NEAR(path.length_inside, 0.3 / cos_t, 0.02 * double(angle) + 1e-4);
        }
    }
}

// A placement that stretches the slab along its normal, and one that also moves, turns and scales it.
TEST_F(Wyman2005, DistancesFollowThePlacement) {
    Scene scene = load_scene("shape:slab,width=2,height=2,thickness=0.3");
    const auto thickness = [&](const glm::mat4& placement) {
        scene.objects.front().world_from_object = placement;
        // Tilted, so that d_N counts.
        const RenderResult result = render(scene, parallel_camera(0.4f, 0.1f), settings_for(3));
        return double(result.paths[4].length_inside);
    };
    const double ratio = std::asin(std::sin(0.4) / kIor) / 0.4, of_one = ratio / std::cos(0.4) + 1.0 - ratio;
    const glm::mat4 one(1.0f);
    EXPECT_NEAR(thickness(glm::scale(one, glm::vec3(2.0f))), 0.6 * of_one, 1e-4);
    EXPECT_NEAR(thickness(glm::scale(one, glm::vec3(1.0f, 1.0f, 3.0f))), 0.9 * of_one, 1e-4);
    EXPECT_NEAR(thickness(glm::scale(one, glm::vec3(1.0f, 1.0f, -3.0f))), 0.9 * of_one, 1e-4);
    EXPECT_NEAR(thickness(glm::translate(one, glm::vec3(0.1f, 0.0f, 0.7f))), 0.3 * of_one, 1e-4);
}

TEST_F(Wyman2005, ASphereIsRightWithinABound) {
    constexpr int kSize = 256;
    const Scene scene = load_scene("shape:sphere,segments=128");
    const Camera camera = framing(scene, 30.0f);
    const RenderResult result = render(scene, camera, settings_for(kSize));
    int covered = 0, within_1 = 0, within_10 = 0;
    for (int i = 0; i < kSize * kSize; ++i) {
        const RefractedPath& path = result.paths[std::size_t(i)];
        const auto exact = through_unit_sphere(pixel_ray(camera, kSize, kSize, i % kSize, i / kSize), kIor);
        if (path.events == 0 || !exact) continue;
        ++covered;
        const double error = angle_deg(path.direction, exact->direction);
        within_1 += error < 1.0 ? 1 : 0;
        within_10 += error < 10.0 ? 1 : 0;
    }
    EXPECT_GT(covered, 20000);
    EXPECT_GT(double(within_1) / covered, 0.4);  // measured: 0.43
    EXPECT_GT(double(within_10) / covered, 0.8);
}

// Behind the critical angle the ray leaves along the surface, and no light is lost there.
TEST_F(Wyman2005, TotalReflectionIsClampedToTheCriticalAngle) {
    const Scene scene = load_scene("shape:cube");
    const RenderResult result =
        render(scene, orbit_camera(scene_bounds(scene), 45.0f, 0.0f, 4.0f, 0.5f), settings_for(128));
    std::size_t clamped = 0;
    for (const RefractedPath& path : result.paths) {
        EXPECT_EQ(path.reflections, 0);
        if (path.events < 2) continue;
        // Rays meet the sides at 45 degrees and leave along the plane of one: a component is zero.
        const glm::vec3 d = glm::abs(path.direction);
        if (std::min(d.x, d.z) > 1e-3f) continue;
        ++clamped;
        EXPECT_GT(path.transmittance.x, 0.8f);
    }
    EXPECT_GT(clamped, result.covered / 5);
}

// d_V alone: the way of the view ray through the slab, laid along the refracted one.
TEST_F(Wyman2005, TheDistanceAlongTheViewRayAloneIsAMode) {
    const Scene scene = load_scene("shape:slab,width=2,height=2,thickness=0.3");
    const RenderResult result = render(scene, parallel_camera(0.4f, 0.1f), settings_for(3, {{"distances", 2}}));
    const RefractedPath& path = result.paths[4];
    EXPECT_EQ(path.status, Status::kOk);
    EXPECT_NEAR(double(path.length_inside), 0.3 / std::cos(0.4), 1e-4);
}

// Seen square on, a prism of 45 degrees throws the view back: in through the hypotenuse, two total reflections.
TEST_F(Wyman2005, InnerReflectionsBounceBetweenTheFaces) {
    Scene scene = load_scene("shape:cube");
    Mesh prism;  // a right angle along Y that points away from the eye, the hypotenuse towards it
    const glm::vec3 corners[] = {{-1, -1, 0}, {1, -1, 0}, {0, -1, -1}, {-1, 1, 0}, {1, 1, 0}, {0, 1, -1}};
    for (const glm::uvec3 t : {glm::uvec3(0, 1, 4), glm::uvec3(0, 4, 3), glm::uvec3(1, 2, 5), glm::uvec3(1, 5, 4),
                               glm::uvec3(2, 0, 3), glm::uvec3(2, 3, 5), glm::uvec3(0, 2, 1), glm::uvec3(3, 4, 5)}) {
        const glm::vec3 n = glm::normalize(glm::cross(corners[t.y] - corners[t.x], corners[t.z] - corners[t.x]));
        for (int k = 0; k < 3; ++k) {
            prism.positions.push_back(corners[t[k]]);
            prism.normals.push_back(n);
        }
        const auto first = std::uint32_t(prism.positions.size()) - 3;
        prism.triangles.push_back({first, first + 1, first + 2});
    }
    scene.meshes[0] = prism;
    constexpr std::uint32_t kSize = 64;
    const Camera camera = parallel_camera(0.0f, 2.5f);
    const auto paths_with = [&](double reflections) {
        return render(scene, camera, settings_for(kSize, {{"inner-reflections", reflections}, {"distances", 2}})).paths;
    };
    const auto followed = paths_with(4), one = paths_with(1), clamped = paths_with(0);
    ExactSettings exact_settings;
    exact_settings.width = exact_settings.height = kSize;
    const auto exact = renderer().tracer().exact(camera, exact_settings);
    int right = 0, cut = 0, covered = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (exact[i].reflections != 2) continue;
        ++covered;
        EXPECT_EQ(clamped[i].reflections, 0);
        EXPECT_EQ(one[i].reflections, 1);
        cut += one[i].status == Status::kEventLimit ? 1 : 0;
        right += followed[i].reflections == 2 && followed[i].status == Status::kOk &&
                         angle_deg(followed[i].direction, exact[i].direction) < 1.0 &&
                         std::abs(followed[i].length_inside - exact[i].length_inside) < 0.1f
                     ? 1
                     : 0;
    }
    // Within a step of the search the walls are not told apart, near the edge where they meet.
    EXPECT_GT(covered, 1000);
    EXPECT_GT(right, covered * 9 / 10);
    EXPECT_GT(cut, covered * 9 / 10);
}

TEST_F(Wyman2005, BothBackFacesAndBothDistancesAreFiniteOnEveryModel) {
    std::vector<std::string> scenes = {"shape:goblet", "shape:knot", "shape:hollow-sphere"};
    if (!data_folder().empty()) {
        for (const auto& file : std::filesystem::directory_iterator(data_folder() / "models")) {
            if (file.is_regular_file() && file.file_size() < 8'000'000) scenes.push_back(file.path().string());
        }
    }
    std::sort(scenes.begin(), scenes.end());
    for (const std::string& source : scenes) {
        const Scene scene = load_scene(source);
        for (const double option : {0.0, 1.0}) {
            const RenderResult result = render(scene, framing(scene, 40.0f),
                                               settings_for(64, {{"back-face", option},
                                                                 {"distances", option},
                                                                 {"table", 8.0},
                                                                 {"inner-reflections", 5.0 * option}}));
            std::uint64_t covered = 0;
            for (const RefractedPath& path : result.paths) {
                covered += path.events > 0 ? 1 : 0;
                ASSERT_TRUE(finite(path)) << source;
                ASSERT_NEAR(glm::length(path.direction), 1.0f, 1e-3f) << source;
            }
            EXPECT_EQ(covered, result.covered) << source;
            EXPECT_GT(covered, 0u) << source;
            EXPECT_TRUE(all_finite(result.radiance)) << source;
        }
    }
}

TEST_F(Wyman2005, TwoRunsAreAlike) {
    const Scene scene = load_scene("shape:knot");
    const RenderResult first = render(scene, framing(scene, 0.0f), settings_for(128));
    const RenderResult second = render(scene, framing(scene, 0.0f), settings_for(128));
    EXPECT_EQ(first.radiance.pixels, second.radiance.pixels);
}

TEST_F(Wyman2005, TheTableOfASphereGivesItsChords) {
    const Scene scene = load_scene("shape:sphere,segments=64");
    const Camera camera = framing(scene, 0.0f);
    constexpr int kSize = 64;
    const RenderResult result = render(scene, camera, settings_for(kSize, {{"distances", 1.0}, {"table", 16.0}}));
    double sum = 0.0;
    int covered = 0;
    for (int i = 0; i < kSize * kSize; ++i) {
        const RefractedPath& path = result.paths[std::size_t(i)];
        const auto exact = through_unit_sphere(pixel_ray(camera, kSize, kSize, i % kSize, i / kSize), kIor);
        if (path.events < 2 || !exact) continue;
        ++covered;
        sum += std::abs(double(path.length_inside) - exact->length);
    }
    EXPECT_GT(covered, 1000);
    EXPECT_LT(sum / covered, 0.05);  // metres, of 1.5 to 2
}

/// A slab, and behind it a plane whose halves left and right of x = 0 are red and green, at a distance from the slab.
Scene slab_before_a_plane(float distance) {
    Scene scene = load_scene("shape:slab,width=2,height=2,thickness=0.3");
    const float z = -0.15f - distance;
    for (const float side : {-1.0f, 1.0f}) {
        Mesh half;
        half.positions = {{0, -4, z}, {4 * side, -4, z}, {4 * side, 4, z}, {0, 4, z}};
        half.normals.assign(4, glm::vec3(0, 0, 1));
        half.triangles =
            side > 0.0f ? std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}} : std::vector<glm::uvec3>{{0, 2, 1}, {0, 3, 2}};
        Material color;
        color.unlit = true;
        color.base_color = side < 0.0f ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, 1);
        Object object;
        object.mesh = int(scene.meshes.size());
        object.material = int(scene.materials.size());
        scene.meshes.push_back(half);
        scene.materials.push_back(color);
        scene.objects.push_back(object);
    }
    return scene;
}

// Seen through the slab, the edge of the halves is where the shifted ray says.
TEST_F(Wyman2005, APlaneBehindASlabIsSeenAtTheRightPlace) {
    constexpr int kSize = 201;
    constexpr float kAngle = 0.5f, kExtent = 0.8f;
    for (const float gap : {-0.15f, 0.0f, 0.02f, 0.3f}) {  // the first within the slab
        const RenderResult result =
            render(slab_before_a_plane(gap), parallel_camera(kAngle, kExtent), settings_for(kSize));
        int edge = -1;
        for (int x = 1; x < kSize && edge < 0; ++x) {
            const auto& path = result.paths[std::size_t(kSize / 2 * kSize + x)];
            const auto& before = result.paths[std::size_t(kSize / 2 * kSize + x - 1)];
            EXPECT_GE(path.object, 1) << gap << " " << x;
            EXPECT_EQ(path.events, gap <= 0.0f ? 1 : 2) << gap << " " << x;
            if (before.object == 1 && path.object == 2) edge = x;
        }
        // The ray that reaches x = 0 on the plane enters the slab at this x.
        const double tan_i = std::tan(double(kAngle)), sin_t = std::sin(double(kAngle)) / kIor;
        const double inside = 0.3 + std::min(double(gap), 0.0), outside = std::max(double(gap), 0.0);
        const double entry = inside * sin_t / std::sqrt(1.0 - sin_t * sin_t) + outside * tan_i;
        // The camera's right axis is (cos, 0, -sin); the entry lies on the plane z = 0.15.
        const double right = entry * std::cos(double(kAngle)) - 0.15 * std::sin(double(kAngle));
        const double pixel = right / (kExtent / kSize) + 0.5 * kSize;
        EXPECT_NEAR(edge, pixel, 2.5) << gap;
        const glm::vec3 left = rgb(result.radiance, edge - 5, kSize / 2),
                        after = rgb(result.radiance, edge + 5, kSize / 2);
        EXPECT_GT(left.x, 0.7f);
        EXPECT_LT(left.y, 0.3f);
        EXPECT_GT(after.y, 0.7f);
        EXPECT_LT(after.x, 0.3f);
    }
}

TEST_F(Wyman2005, WithoutOpaqueObjectsPathsEndInTheEnvironment) {
    const Scene scene = load_scene("shape:torus");
    for (const RefractedPath& path : render(scene, framing(scene, 0.0f), settings_for(64)).paths) {
        EXPECT_EQ(path.object, -1);
    }
}

}  // namespace
}  // namespace pellucid::test
