// Exact paths and path-traced pictures through volumes, against rays and integrals that are known.
#include "built_scenes.h"
#include "built_volumes.h"
#include "closed_form/solid_file.h"
#include "traced_scenes.h"

#include <pellucid/reference.h>
#include <pellucid/volume.h>

#include <glm/gtc/matrix_transform.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

namespace pellucid::test {
namespace {

std::vector<RefractedPath> exact(const Scene& scene, const Camera& camera, std::uint32_t size) {
    return Tracer(scene, {}).exact(camera, {.width = size, .height = size});
}

glm::vec3 pixel(const Scene& scene, const Camera& camera, const Environment& environment, std::uint32_t samples) {
    const Tracer tracer(scene, {});
    const PathTracedImage image = tracer.path_trace(camera, environment, {.width = 1, .height = 1, .samples = samples});
    return {image.radiance.pixels[0], image.radiance.pixels[1], image.radiance.pixels[2]};
}

/// Distance between a point and the line of a path's last piece.
double distance_to_line(const RefractedPath& path, const glm::dvec3& point) {
    return glm::length(glm::cross(point - glm::dvec3(path.position), glm::dvec3(path.direction)));
}

// Luneburg's lens of a radius of 60 voxels. Beyond the ball rays are straight, and the box is left after it, so the line
// of the last piece passes the focus. The kink of the index at r = R is what cubics cannot follow.
TEST(CurvedVolumes, LuneburgFocusesParallelRays) {
    Scene scene;
    add_volume(scene, make_volume("luneburg,resolution=120"));
    const double voxel = double(scene.volumes[0]->voxel);
    constexpr std::uint32_t kSize = 40;
    const Camera camera = parallel_camera({0, 0, 0}, {0.0f, 0.0f, -1.0f}, 1.8f);
    double squares = 0.0, largest = 0.0;
    int counted = 0;
    const std::vector<RefractedPath> paths = exact(scene, camera, kSize);
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
        const glm::dvec2 film = (glm::dvec2(i % kSize, i / kSize) + 0.5) / double(kSize) * 1.8 - 0.9;
        if (glm::length(film) > 0.9) continue;
        const double miss = distance_to_line(paths[i], {0.0, 0.0, -1.0}) / voxel;
        squares += miss * miss;
        largest = std::max(largest, miss);
        ++counted;
        EXPECT_EQ(paths[i].events, 1);
        EXPECT_EQ(paths[i].status, Status::kOk);
    }
    EXPECT_LT(std::sqrt(squares / counted), 0.05);
    EXPECT_LT(largest, 0.2);
    RecordProperty("rms_voxels", std::to_string(std::sqrt(squares / counted)));
}

// n = n0 + a y: v along x stays, and the ray is a catenary. Cubics are exact there.
TEST(CurvedVolumes, LinearIndexBendsAlongACatenary) {
    Scene scene;
    add_volume(scene, make_volume("linear,size=2,n0=1.5,slope=0.3"),
               glm::translate(glm::mat4(1.0f), glm::vec3(5.0f, 0.0f, 0.0f)));
    const Camera camera = parallel_camera({0, 0, 0}, {1.0f, 0.0f, 0.0f}, 1.0f);
    constexpr std::uint32_t kSize = 8;
    const std::vector<RefractedPath> paths = exact(scene, camera, kSize);
    for (std::uint32_t row = 0; row < kSize; ++row) {
        const RefractedPath& path = paths[row * kSize + 3];
        const double y = 0.5 - (row + 0.5) / kSize, n = 1.5 + 0.3 * y;
        EXPECT_NEAR(double(path.direction.y / path.direction.x), std::sinh(0.6 / n), 1e-5);
        EXPECT_NEAR(double(path.position.y), y + (n * std::cosh(0.6 / n) - n) / 0.3, 1e-5);
        EXPECT_NEAR(double(path.position.x), 6.0, 1e-5);
        EXPECT_NEAR(double(path.length), 14.0 + n / 0.3 * std::sinh(0.6 / n), 1e-5);  // arc of the catenary
    }
}

TEST(CurvedVolumes, OneChannelForEachColour) {
    Volume volume = make_volume("linear,size=2,n0=1.5,slope=0.3");
    volume.n_red = volume.n_blue = volume.n;
    for (float& n : volume.n_blue) n = 1.5f + 2.0f * (n - 1.5f);
    Scene scene;
    add_volume(scene, std::move(volume));
    const Camera camera = parallel_camera({0, 0, 0}, {1.0f, 0.0f, 0.0f}, 1e-3f);
    const Tracer tracer(scene, {});
    for (const auto& [channel, slope] : {std::pair{0u, 0.3}, std::pair{2u, 0.6}}) {
        const RefractedPath path = tracer.exact(camera, {.width = 1, .height = 1, .channel = channel}).front();
        EXPECT_NEAR(double(path.direction.y / path.direction.x), std::sinh(2.0 * slope / 1.5), 1e-5);
    }
}

TEST(CurvedVolumes, AbsorbAndEmit) {
    const glm::vec3 sigma_a(0.5f, 1.0f, 0.0f), emission(0.0f, 2.0f, 3.0f);
    const Camera camera = parallel_camera({0.01f, 0.02f, 0.0f}, {0.0f, 0.0f, -1.0f}, 1e-3f);
    for (const float scale : {1.0f, 4.0f}) {  // a scale leaves what a ray loses and picks up
        Scene scene;
        add_volume(scene, even(sigma_a, emission, 1.3f), glm::scale(glm::mat4(1.0f), glm::vec3(scale)));
        const RefractedPath path = exact(scene, camera, 1).front();
        EXPECT_NEAR(path.length_inside, 2.0f * scale, 1e-5f);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(path.transmittance[c], std::exp(-2.0f * sigma_a[c]), 1e-6f);
        const glm::vec3 seen = pixel(scene, camera, uniform(0.25f), 4);
        for (int c = 0; c < 3; ++c) {
            const float left = std::exp(-2.0f * sigma_a[c]);
            const float added = sigma_a[c] > 0.0f ? emission[c] * (1.0f - left) / sigma_a[c] : 2.0f * emission[c];
            EXPECT_NEAR(seen[c], 0.25f * left + added, 1e-5f) << scale << ", " << c;
        }
    }
    Scene half;  // a wall in the middle
    add_volume(half, even(sigma_a, emission));
    Material paint;
    paint.unlit = true;
    add(half, square(), paint);
    const RefractedPath path = exact(half, camera, 1).front();
    EXPECT_EQ(path.object, 0);
    EXPECT_NEAR(path.position.z, 0.0f, 1e-6f);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(path.transmittance[c], std::exp(-sigma_a[c]), 1e-6f);
}

// A slab before a white wall, in the dark: (1 - R)^2 of the transmitted path, (1 - R) / (1 + R) with all that is reflected
// inside. 0.5% where the smoothing is 1 voxel; a picture of 20,000 samples scatters by 0.3%, and four times that is allowed.
TEST(CurvedVolumes, SurfacesReflectAsFresnelSays) {
    for (const float n : {1.5f, 2.42f}) {
        Scene scene;
        add_volume(scene, slab(n, 1.0, 32));
        Material white;
        white.unlit = white.double_sided = true;
        add(scene, square(), white, glm::scale(glm::translate(glm::mat4(1.0f), {0, 0, -1.0f}), glm::vec3(3.0f)));
        const Camera camera = parallel_camera({0, 0, 0}, {0.0f, 0.0f, -1.0f}, 0.01f);
        const double r = std::pow((double(n) - 1.0) / (double(n) + 1.0), 2.0);
        const double passed = double(exact(scene, camera, 1)[0].transmittance.g);
        EXPECT_NEAR(passed / ((1.0 - r) * (1.0 - r)), 1.0, 0.005);
        Environment dark;
        dark.kind = Environment::Kind::kUniform;
        dark.uniform_radiance = glm::vec3(0.0f);
        const double seen = double(pixel(scene, camera, dark, 20000).g);
        EXPECT_NEAR(seen * (1.0 + r) / (1.0 - r), 1.0, 0.012);
        std::printf("slab of %.2f: transmitted %.4f, exact %.4f; seen %.4f, exact %.4f\n", double(n), passed,
                    (1.0 - r) * (1.0 - r), seen, (1.0 - r) / (1.0 + r));
    }
}

// Glass of the volume's own index is not to be seen in it; a wall is met where the bent ray meets it.
TEST(CurvedVolumes, SurfacesInVolumes) {
    Scene scene;
    add_volume(scene, even(glm::vec3(0.0f), glm::vec3(0.0f), 1.5f));
    add(scene, with_flat_normals(cube(0.5f, {-0.2f, -0.3f, -0.1f})), glass(1.5f));
    const Camera camera = parallel_camera({0.01f, 0.02f, 0.0f}, glm::normalize(glm::vec3(0.03f, 0.02f, -1.0f)), 0.3f);
    for (const RefractedPath& path : exact(scene, camera, 8)) {
        EXPECT_LT(glm::distance(path.direction, exact(scene, camera, 1).front().direction), 1e-6f);
        EXPECT_EQ(path.status, Status::kOk);
    }
    Scene bent;
    add_volume(bent, make_volume("linear,size=2,n0=1.5,slope=0.3"));
    Material paint;
    paint.unlit = true;
    paint.double_sided = true;
    add(bent, square(), paint, glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(0, 1, 0)));  // in the plane x = 0
    const Camera along = parallel_camera({0.0f, 0.1f, 0.01f}, {1.0f, 0.0f, 0.0f}, 1e-3f);
    const RefractedPath path = exact(bent, along, 1).front();
    const double n = 1.5 + 0.03;
    EXPECT_EQ(path.object, 0);
    EXPECT_NEAR(double(path.position.y), 0.1 + (n * std::cosh(0.3 / n) - n) / 0.3, 1e-4);
}

// The smaller of two boxes counts where they overlap: rays bend in it alone.
TEST(CurvedVolumes, SmallerBoxesCount) {
    Scene scene;
    add_volume(scene, even(glm::vec3(1.0f), glm::vec3(0.0f)));
    add_volume(scene, even(glm::vec3(0.0f), glm::vec3(0.0f)), glm::scale(glm::mat4(1.0f), glm::vec3(0.5f)));
    const RefractedPath path =
        exact(scene, parallel_camera({0.01f, 0.02f, 0.0f}, {0.0f, 0.0f, -1.0f}, 1e-3f), 1).front();
    EXPECT_NEAR(path.transmittance.g, std::exp(-1.0f), 1e-5f);
}

/// A solid of glass that holds a volume.
Scene holding(Volume volume, const Material& material = glass()) {
    Scene scene = scene_of(ball_mesh(5), material);
    add_volume(scene, std::move(volume));
    scene.volume_objects.back().objects = {0};
    return scene;
}

// Of the glass's own index, the volume changes nothing; its absorption takes the place of the glass's.
TEST(CurvedVolumes, SolidsHoldVolumes) {
    const Camera camera = parallel_camera({0, 0, 0}, {0.0f, 0.1f, -1.0f}, 2.1f);
    const std::vector<RefractedPath> plain = exact(scene_of(ball_mesh(5)), camera, 24);
    const std::vector<RefractedPath> held = exact(holding(graded_ball(1.5f, 0.0f)), camera, 24);
    int through = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
        EXPECT_EQ(plain[i].events, held[i].events) << i;
        EXPECT_LT(glm::distance(plain[i].direction, held[i].direction), 1e-5f) << i;
        EXPECT_NEAR(plain[i].length_inside, held[i].length_inside, 1e-4f) << i;
        through += plain[i].events > 0 ? 1 : 0;
    }
    EXPECT_GT(through, 300);

    Volume dark = graded_ball(1.5f, 0.0f);
    dark.sigma_a.assign(dark.voxel_count(), glm::vec3(0.0f, 0.7f, 0.0f));
    Material absorbing = glass();
    absorbing.attenuation_color = glm::vec3(0.5f);
    absorbing.attenuation_distance = 0.1f;
    const std::vector<RefractedPath> absorbed = exact(holding(std::move(dark), absorbing), camera, 24);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        if (plain[i].events == 0) continue;
        EXPECT_NEAR(absorbed[i].transmittance.r, plain[i].transmittance.r, 1e-4f) << i;
        EXPECT_NEAR(absorbed[i].transmittance.g, plain[i].transmittance.g * std::exp(-0.7f * plain[i].length_inside),
                    1e-4f)
            << i;
    }
}

/// Angle by which a unit ball of index middle - fall r^2 turns a ray that passes its middle at the distance h: what is
/// left of pi after both angles of incidence and the angle at the middle, 2 * integral of h / (r sqrt(n^2 r^2 - h^2)).
double bouguer_deviation(double middle, double fall, double h) {
    const auto n = [&](double r) { return middle - fall * r * r; };
    double low = 0.0, high = 1.0;  // where the ray is nearest to the middle, n r = h
    for (int i = 0; i < 60; ++i) {
        const double r = 0.5 * (low + high);
        (n(r) * r < h ? low : high) = r;
    }
    constexpr int kSteps = 20'000;
    const double end = std::sqrt(1.0 - high);
    double angle = 0.0;
    for (int i = 0; i < kSteps; ++i) {  // r = high + s^2: no pole at the nearest point
        const double s = end * (i + 0.5) / kSteps, r = high + s * s;
        angle += 2.0 * h / (r * std::sqrt(n(r) * n(r) * r * r - h * h)) * 2.0 * s * end / kSteps;
    }
    return std::numbers::pi - 2.0 * std::asin(h) - angle;
}

// In a field of which the centre is that of the ball, n r sin(angle) stays (Bouguer): what enters leaves at the same angle.
TEST(CurvedVolumes, GradedBallsBendAsBouguerSays) {
    const Scene scene = holding(graded_ball(1.8f, 0.3f));
    constexpr std::uint32_t kSize = 24;
    const Camera camera = parallel_camera({0, 0, 0}, {0.0f, 0.0f, -1.0f}, 2.1f);
    const std::vector<RefractedPath> paths = exact(scene, camera, kSize);
    int through = 0;
    for (const RefractedPath& path : paths) {
        if (path.events != 2 || path.reflections != 0) continue;
        const glm::dvec2 film =
            (glm::dvec2((&path - paths.data()) % kSize, (&path - paths.data()) / kSize) + 0.5) / double(kSize) * 2.1 -
            1.05;
        const double impact = glm::length(film);
        if (impact > 0.95) continue;
        ++through;
        const double out = glm::length(glm::cross(glm::dvec3(path.position), glm::dvec3(path.direction)));
        EXPECT_NEAR(out, impact, 2e-3);  // balls of triangles
        const double turned = std::acos(std::clamp(-double(path.direction.z), -1.0, 1.0));
        EXPECT_NEAR(turned, std::abs(bouguer_deviation(1.8, 0.3, impact)), 5e-3) << impact;
    }
    EXPECT_GT(through, 200);
}

}  // namespace
}  // namespace pellucid::test
