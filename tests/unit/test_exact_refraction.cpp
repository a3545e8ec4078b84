// The exact tracer against what is known without it.

#include "traced_scenes.h"

#include <pellucid/error.h>
#include <pellucid/reference.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace pellucid {
namespace {

using glm::dvec3;
using namespace test;

/// Refraction in the plane of incidence, by angles; empty under total reflection.
std::optional<dvec3> snell(const dvec3& d, const dvec3& n, double n_i, double n_t) {
    const dvec3 across = d - glm::dot(d, n) * n;
    const double sin_i = glm::length(across);
    const double sin_t = sin_i * n_i / n_t;
    if (sin_t > 1.0) return {};
    const dvec3 tangent = sin_i > 0.0 ? across / sin_i : dvec3(0.0);
    return sin_t * tangent - std::cos(std::asin(sin_t)) * n;
}

/// Distance to the nearer (or farther) crossing of a sphere about the origin.
std::optional<double> meet_sphere(const dvec3& o, const dvec3& d, double radius, bool farther) {
    const double b = glm::dot(o, d), c = glm::dot(o, o) - radius * radius, root = b * b - c;
    if (root < 0.0) return {};
    const double t = farther ? -b + std::sqrt(root) : -b - std::sqrt(root);
    return t > 1e-9 ? std::optional(t) : std::nullopt;
}

dvec3 view_ray(const Camera& camera, std::uint32_t size, std::size_t pixel) {
    const double x = double(pixel % size) + 0.5 - 0.5 * size, y = 0.5 * size - (double(pixel / size) + 0.5);
    const double scale = 2.0 * std::tan(0.5 * double(camera.vertical_fov)) / size;
    return glm::normalize(glm::dmat3(camera.world_from_view) * dvec3(x * scale, y * scale, -1.0));
}

TEST(ExactRefraction, SphereBendsAsASphere) {
    const Scene scene = load_scene("shape:sphere,segments=256");
    const Camera camera = view_of(scene, 0.0f);
    const std::uint32_t size = 256;
    const std::vector<RefractedPath> paths = trace(scene, camera, size);
    const dvec3 eye(camera.world_from_view[3]);
    double covered = 0, right = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const dvec3 d = view_ray(camera, size, i);
        const auto t = meet_sphere(eye, d, 1.0, false);
        if (!t) continue;
        const dvec3 in = eye + *t * d;
        const dvec3 inside = *snell(d, in, 1.0, 1.5);
        const dvec3 out = in + *meet_sphere(in, inside, 1.0, true) * inside;
        ++covered;
        right += paths[i].events == 2 && angle_deg(paths[i].direction, *snell(inside, -out, 1.5, 1.0)) < 1.0;
        // Away from the silhouette, where tessellation shows, no path is totally reflected.
        EXPECT_TRUE(paths[i].reflections == 0 || glm::dot(d, in) > -0.05) << i;
    }
    EXPECT_GT(covered, 0.25 * size * size);
    EXPECT_GE(right / covered, 0.999);
}

TEST(ExactRefraction, HollowSphereBendsFourTimes) {
    const Scene scene = load_scene("shape:hollow-sphere,segments=256,inner=0.8");
    const Camera camera = view_of(scene, 0.0f);
    const std::uint32_t size = 128;
    const std::vector<RefractedPath> paths = trace(scene, camera, size);
    const dvec3 eye(camera.world_from_view[3]);
    double four = 0, right = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const dvec3 d = view_ray(camera, size, i);
        const auto t = meet_sphere(eye, d, 1.0, false);
        if (!t) continue;
        dvec3 p = eye + *t * d;
        dvec3 w = *snell(d, p, 1.0, 1.5);
        const auto cavity = meet_sphere(p, w, 0.8, false);
        if (!cavity) continue;
        p += *cavity * w;
        const auto in_air = snell(w, p / 0.8, 1.5, 1.0);
        if (!in_air) continue;
        p += *meet_sphere(p, *in_air, 0.8, true) * *in_air;
        w = *snell(*in_air, -p / 0.8, 1.0, 1.5);
        p += *meet_sphere(p, w, 1.0, true) * w;
        ++four;
        right += paths[i].events == 4 && angle_deg(paths[i].direction, *snell(w, -p, 1.5, 1.0)) < 1.0;
    }
    EXPECT_GT(four, 1000);
    EXPECT_GE(right / four, 0.995);
}

TEST(ExactRefraction, SlabShiftsAndDoesNotTurn) {
    const Scene scene = load_scene("shape:slab,width=20,height=20,thickness=0.5");
    for (const double theta : {0.0, 0.3, 0.8, 1.2}) {
        const dvec3 d(std::sin(theta), 0.0, -std::cos(theta));
        const dvec3 entry(0.0, 0.0, 0.25);
        const RefractedPath path = trace_ray(scene, glm::vec3(entry), glm::vec3(d));
        const double theta_t = std::asin(std::sin(theta) / 1.5);
        EXPECT_EQ(path.events, 2);
        EXPECT_LT(angle_deg(path.direction, d), 1e-4);
        // Sideways from the straight line, t sin(theta_i - theta_t) / cos(theta_t).
        const dvec3 offset = dvec3(path.position) - entry;
        const double shift = glm::length(offset - glm::dot(offset, d) * d);
        EXPECT_NEAR(shift, 0.5 * std::sin(theta - theta_t) / std::cos(theta_t), 1e-5);
        EXPECT_NEAR(path.length_inside, 0.5 / std::cos(theta_t), 1e-5);
        EXPECT_NEAR(path.length, 10.0 + 0.5 / std::cos(theta_t), 1e-4);
    }
}

TEST(ExactRefraction, SlabTransmitsWhatFresnelAndBeerLeave) {
    Scene scene = load_scene("shape:slab,width=20,height=20,thickness=0.5");
    scene.materials[0].attenuation_color = {0.5f, 0.25f, 1.0f};
    scene.materials[0].attenuation_distance = 0.25f;
    const RefractedPath path = trace_ray(scene, {0.1f, 0.2f, 0.0f}, {0, 0, -1});
    const float fresnel = 0.96f * 0.96f;
    EXPECT_NEAR(path.transmittance.r, fresnel * 0.25f, 1e-5f);
    EXPECT_NEAR(path.transmittance.g, fresnel * 0.0625f, 1e-5f);
    EXPECT_NEAR(path.transmittance.b, fresnel, 1e-5f);
    // Brewster's angle: half of the light, in the plane of incidence, is transmitted whole.
    const double brewster = std::atan(1.5);
    const RefractedPath slanted =
        trace_ray(scene, glm::vec3(0.0f), {float(std::sin(brewster)), 0, -float(std::cos(brewster))});
    const double across = std::pow((1.0 - 2.25) / (1.0 + 2.25), 2.0);
    EXPECT_NEAR(slanted.transmittance.b, std::pow(1.0 - 0.5 * across, 2.0), 1e-5);
}

TEST(ExactRefraction, PrismDeviatesLeastWhereItIsSymmetric) {
    const float h = std::sqrt(3.0f);
    const Scene scene = scene_of(prism({-1, 0}, {1, 0}, {0, h}));
    const double apex = glm::radians(60.0);
    const dvec3 left_normal(-std::cos(apex / 2), std::sin(apex / 2), 0.0);
    double least = 180.0;
    for (double i = 0.75; i < 0.95; i += 0.005) {
        const dvec3 along(left_normal.y, -left_normal.x, 0.0);  // from the left face towards the base
        const dvec3 d = -std::cos(i) * left_normal - std::sin(i) * along;
        const RefractedPath path = trace_ray(scene, {-0.5f, 0.5f * h, 0.0f}, glm::vec3(d));
        ASSERT_EQ(path.events, 2) << i;
        const double e = std::asin(1.5 * std::sin(apex - std::asin(std::sin(i) / 1.5)));
        const double deviation = angle_deg(d, path.direction);
        EXPECT_NEAR(deviation, glm::degrees(i + e - apex), 1e-4);
        least = std::min(least, deviation);
    }
    EXPECT_NEAR(least, glm::degrees(2.0 * std::asin(1.5 * std::sin(apex / 2)) - apex), 1e-3);
}

TEST(ExactRefraction, RightAnglePrismReflectsAboveTheCriticalIndex) {
    // In through the left leg, onto the hypotenuse at 45 degrees: total where ior > sqrt(2).
    for (const float ior : {1.40f, 1.43f, 1.5f}) {
        const Scene scene = scene_of(prism({0, 0}, {2, 0}, {0, 2}), glass(ior));
        const RefractedPath path = trace_ray(scene, {0.0f, 0.7f, 0.1f}, {1, 0, 0});
        const bool total = ior > std::sqrt(2.0f);
        EXPECT_EQ(path.reflections, total ? 1 : 0) << ior;
        EXPECT_EQ(path.events, total ? 3 : 2) << ior;
        EXPECT_EQ(path.status, Status::kOk);
        if (total) {
            EXPECT_LT(angle_deg(path.direction, dvec3(0, -1, 0)), 1e-4);
            EXPECT_LT(glm::distance(path.position, glm::vec3(1.3f, 0.0f, 0.1f)), 1e-6f);
        }
    }
}

TEST(ExactRefraction, CameraInGlassStartsInItsMedium) {
    const Scene scene = load_scene("shape:sphere,segments=128");
    Camera camera;
    camera.vertical_fov = 1.0f;
    const std::uint32_t size = 16;
    const std::vector<RefractedPath> paths = trace(scene, camera, size);
    for (std::size_t i = 0; i < paths.size(); ++i) {
        EXPECT_EQ(paths[i].events, 1);
        EXPECT_LT(angle_deg(paths[i].direction, view_ray(camera, size, i)), 0.1);
        EXPECT_NEAR(paths[i].length_inside, 1.0, 1e-3);
    }
}

TEST(ExactRefraction, GlassLikeAirDoesNotBend) {
    Scene scene = load_scene("shape:knot");
    scene.materials[0].ior = 1.0f;
    const Camera camera = view_of(scene, 30.0f);
    const std::uint32_t size = 64;
    const std::vector<RefractedPath> paths = trace(scene, camera, size);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        EXPECT_LT(angle_deg(paths[i].direction, view_ray(camera, size, i)), 1e-4);
        EXPECT_EQ(paths[i].events % 2, 0);
        EXPECT_EQ(paths[i].reflections, 0);
        EXPECT_EQ(paths[i].transmittance, glm::vec3(1.0f));
        covered += paths[i].events > 0;
    }
    EXPECT_GT(covered, 500u);
}

TEST(ExactRefraction, FollowsAsManyEventsAsAsked) {
    const Scene scene = load_scene("shape:slab");
    const Tracer tracer(scene);
    const Camera camera = parallel_camera({0.1f, 0.2f, 0.0f}, {0, 0, -1}, 0.01f);
    ExactSettings settings;
    settings.width = settings.height = 1;
    settings.max_events = 1;
    const RefractedPath cut = tracer.exact(camera, settings).front();
    EXPECT_EQ(cut.status, Status::kEventLimit);
    EXPECT_EQ(cut.events, 1);
    settings.max_events = 2;
    EXPECT_EQ(tracer.exact(camera, settings).front().status, Status::kOk);
}

TEST(ExactRefraction, ShiftMovesTheRayRightAndDown) {
    const Scene scene = load_scene("shape:sphere");
    const Camera camera = view_of(scene, 0.0f);
    const Tracer tracer(scene);
    ExactSettings settings;
    settings.width = settings.height = 64;
    const std::vector<RefractedPath> centred = tracer.exact(camera, settings);
    settings.shift_px = {1.0, 1.0};
    const std::vector<RefractedPath> shifted = tracer.exact(camera, settings);
    for (std::size_t y = 0; y + 1 < 64; ++y)
        for (std::size_t x = 0; x + 1 < 64; ++x)
            EXPECT_EQ(shifted[64 * y + x].direction, centred[64 * (y + 1) + x + 1].direction);
}

TEST(ExactRefraction, RefusesSettingsThatMakeNoSense) {
    const Scene scene = load_scene("shape:sphere,segments=4");
    Tracer tracer(scene);
    const Camera camera = view_of(scene, 0.0f);
    const auto refuses = [&](const ExactSettings& settings) { EXPECT_THROW(tracer.exact(camera, settings), Error); };
    refuses({.width = 0});
    refuses({.height = 0});
    refuses({.max_events = 0});
    refuses({.max_events = 65536});
    refuses({.shift_px = {0.0, std::numeric_limits<double>::quiet_NaN()}});
    refuses({.packet = 2});
    refuses({.channel = 3});
    Camera flat = camera;
    flat.vertical_fov = 0.0f;
    EXPECT_THROW(tracer.exact(flat, {}), Error);

    const Mesh& mesh = scene.meshes[0];
    const auto rebuild = Tracer::Update::kRebuild;
    EXPECT_THROW(tracer.set_positions({{1, mesh.positions, mesh.normals}}, rebuild), Error);
    EXPECT_THROW(tracer.set_positions({{0, {}, mesh.normals}}, rebuild), Error);
    EXPECT_THROW(tracer.set_positions({{0, mesh.positions, {}}}, rebuild), Error);
    EXPECT_THROW(tracer.set_positions({{0, mesh.positions, mesh.normals}}, Tracer::Update::kRefit), Error);
}

}  // namespace
}  // namespace pellucid
