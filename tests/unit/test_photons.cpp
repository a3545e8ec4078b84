// Light that mirrors and refracts before it meets something that scatters, against known answers.
#include "closed_form/lights.h"
#include "path_pictures.h"
#include "reference/dielectric.h"
#include "reference/photon_emission.h"
#include "traced_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace pellucid::reference {
namespace {

using namespace test;
using std::numbers::pi;

std::vector<Photon> photons_of(const Scene& scene, std::uint32_t count) {
    const Geometry geometry(scene, {});
    const CurvedVolumes volumes(scene, geometry);
    const Environment dark = uniform(0.0f);
    const EnvironmentSampler sampler(dark);
    const PathWorld world{geometry, volumes, scene, dark, sampler, 256, true};
    return shoot_photons(world, PhotonEmitter(geometry, volumes, scene), count, 1, 0);
}

/// Flux of the photons that fly up or down, W.
struct Flux {
    glm::dvec3 down{0.0}, up{0.0};
    glm::dvec3 all() const { return down + up; }
};
Flux flux_of(const std::vector<Photon>& photons) {
    Flux flux;
    for (const Photon& photon : photons) (photon.direction.y < 0.0f ? flux.down : flux.up) += glm::dvec3(photon.flux);
    return flux;
}

/// Flux, W, that a light sends onto a convex mesh: by the areas, or solid angles, of the triangles that face it (Van
/// Oosterom & Strackee, "The solid angle of a plane triangle", 1983).
double flux_onto(const Mesh& mesh, const Light& light) {
    double sum = 0.0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        const glm::dvec3 p = a - glm::dvec3(light.position), q = b - glm::dvec3(light.position),
                         r = c - glm::dvec3(light.position);
        const double lp = glm::length(p), lq = glm::length(q), lr = glm::length(r);
        const double facing =
            light.kind == Light::Kind::kDirectional
                ? -0.5 * glm::dot(glm::cross(b - a, c - a), glm::dvec3(light.direction))
                : -2.0 * std::atan2(glm::dot(p, glm::cross(q, r)),
                                    lp * lq * lr + glm::dot(p, q) * lr + glm::dot(p, r) * lq + glm::dot(q, r) * lp);
        sum += std::max(facing, 0.0);
    }
    return sum * double(light.intensity.r);
}

/// `glass` in a black box that light enters freely.
Scene in_black_box(Scene scene) {
    Material black = matt(0.0f);
    black.double_sided = false;
    add(scene, with_flat_normals(inside_out(cube(12.0f))), black);
    return scene;
}

TEST(PhotonMap, FindsWhatASearchOfAllFinds) {
    Random random(3, 0, 0);
    const auto anywhere = [&] { return glm::dvec3(random.next(), random.next(), 0.2 * random.next()) - 0.3; };
    std::vector<Photon> photons;
    for (int i = 0; i < 2000; ++i) {
        const float side = random.next() < 0.5 ? 1.0f : -1.0f;
        photons.push_back({anywhere(), {0, 0, side}, {0, 0, -side}, glm::vec3(float(i))});
        photons.back().radius = i % 2 == 0 ? 0.07f : 0.03f;
    }
    const PhotonMap map(photons);
    EXPECT_EQ(map.photons().size(), photons.size());
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 at = 1.2 * anywhere();
        double found = 0.0, expected = 0.0;
        map.for_each_near(at, {0, 0, 1}, [&](const Photon& photon) { found += 1.0 + double(photon.flux.r); });
        for (const Photon& photon : photons)
            if (photon.normal.z > 0.0f && glm::length(photon.position - at) <= double(photon.radius))
                expected += 1.0 + double(photon.flux.r);
        EXPECT_EQ(found, expected);
    }
}

TEST(PhotonMap, TheRadiusShrinksByItsLaw) {
    EXPECT_EQ(photon_radius(2.0, 0), 2.0);
    EXPECT_NEAR(photon_radius(2.0, 1), 2.0 * std::sqrt((1 + 2.0 / 3) / 2), 1e-12);
    // The square falls as the number of rounds to the power of alpha - 1.
    EXPECT_NEAR(std::pow(photon_radius(1.0, 79999) / photon_radius(1.0, 9999), 2), std::pow(8.0, -1.0 / 3), 1e-4);
}

TEST(Photons, ABlackBoxGetsWhatMeetsClearGlass) {
    for (const Light& light : {sun({0.3f, -1, 0.2f}, 3.0f), lamp({1.2f, 2, -0.7f}, 3.0f)}) {
        Mesh ball = load_scene("shape:sphere,segments=24").meshes[0];
        Scene scene = scene_of(with_flat_normals(ball), glass());
        scene.lights = {light};
        const double expected = flux_onto(ball, light);
        EXPECT_NEAR(flux_of(photons_of(in_black_box(scene), 500000)).all().g, expected, 0.01 * expected);
    }
}

/// Of light on a ball that absorbs e^-`depth` along a diameter, the share that leaves: every ring reflects r, and the rest
/// goes to and fro along chords.
double share_that_leaves(double ior, double depth) {
    constexpr int kRings = 20000;
    double sum = 0.0;
    for (int i = 0; i < kRings; ++i) {
        const double sin2 = (i + 0.5) / kRings, cos_i = std::sqrt(1.0 - sin2),
                     cos_t = std::sqrt(1.0 - sin2 / ior / ior);
        const double s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t),
                     p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t);
        const double r = 0.5 * (s * s + p * p), a = std::exp(-depth * cos_t);
        sum += r + (1 - r) * (1 - r) * a / (1 - r * a);
    }
    return sum / kRings;
}

TEST(Photons, ABlackBoxGetsWhatAnAbsorbingBallLeaves) {
    // Interpolated normals: photons take the weight of Veach 1997, 5.3.
    Scene ball = load_scene("shape:sphere,segments=128");
    ball.lights = {sun({0.3f, -1, 0.2f}, 3.0f)};
    const double entered = flux_onto(ball.meshes[0], ball.lights[0]);
    const float diameter = 2.0f * scene_bounds(ball).half_size.x;
    ball.materials[0].attenuation_color = {1.0f, 0.5f, 0.1f};
    ball.materials[0].attenuation_distance = diameter;
    const glm::dvec3 flux = flux_of(photons_of(in_black_box(ball), 500000)).all();
    const std::array<double, 3> depths{0.0, std::log(2.0), std::log(10.0)};
    const double ior = double(ball.materials[0].ior);
    for (int c = 0; c < 3; ++c) {
        const double expected = entered * share_that_leaves(ior, depths[std::size_t(c)]);
        EXPECT_NEAR(flux[c], expected, 0.01 * expected) << "channel " << c;
    }
}

TEST(Photons, APlateSharesOutASunAsItsSeriesSays) {
    for (const float ior : {1.5f, 2.4f}) {
        for (const float transmission : {1.0f, 0.5f}) {
            SCOPED_TRACE(testing::Message() << "index " << ior << ", transmission " << transmission);
            Scene scene = scene_of(with_flat_normals(cube()), glass(ior));
            scene.materials[0].base_color = {1.0f, 0.5f, 0.25f, 1.0f};
            scene.materials[0].transmission = transmission;
            scene.lights = {sun({0, -1, 0}, 1.0f)};
            const Flux flux = flux_of(photons_of(in_black_box(scene), 500000));
            const double n = double(ior), through = 2 * n / (n * n + 1), r = std::pow((n - 1) / (n + 1), 2);
            const glm::dvec3 base(1.0, 0.5, 0.25), leaves = double(transmission) * base;
            const glm::dvec3 down = leaves * through, up = r + leaves * (1 - through - r);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(flux.down[c], down[c], 0.01 * down[c]) << "tinted once, where it leaves";
                EXPECT_NEAR(flux.up[c], up[c], 0.03 * up[c]) << "reflected outside and in";
            }
        }
    }
}

TEST(Photons, InterpolatedNormalsLightWhatPathsFromTheEyeSee) {
    // A plate whose upper normals lean by 30 degrees. Paths from the eye carry radiance T L through it, whatever the
    // normals, into the solid angle that both refractions leave of the sun's: dw cos(d) = n^2 dw' cos(t), by the leaning
    // normal, then n^2 dw' cos(g) = dw'' cos(theta''). So the floor gets T E cos(d) cos(g) / cos(t).
    const double d = pi / 6, t = std::asin(std::sin(d) / 1.5), g = d - t;
    Mesh plate = with_flat_normals(cube());
    for (std::size_t i = 0; i < plate.positions.size(); ++i) {
        plate.positions[i].y *= 0.02f;
        if (plate.normals[i].y > 0.5f) plate.normals[i] = {float(std::sin(d)), float(std::cos(d)), 0.0f};
    }
    Scene scene = scene_of(plate, glass());
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    add(scene, floor_at(-0.1f), matt(0.0f));
    double irradiance = 0.0;
    const double across = -1.5 * std::sin(g);
    for (const Photon& photon : photons_of(scene, 500000)) {
        const bool once = std::abs(double(photon.direction.x) - across) < 1e-3;  // not reflected in the plate
        const glm::dvec3 at = glm::abs(photon.position);
        if (once && at.x < 0.3 && at.z < 0.3) irradiance += double(photon.flux.g) / 0.36;
    }
    const auto passes = [](double cos_i) { return 1.0 - incidence({0, 0, -cos_i}, {0, 0, 1}, 1.0, 1.5).reflectance; };
    const double cos_out = std::sqrt(1.0 - across * across);
    const double expected = passes(std::cos(d)) * passes(cos_out) * std::cos(d) * std::cos(g) / std::cos(t);
    EXPECT_NEAR(irradiance, expected, 0.01 * expected);
}

TEST(Photons, ABallLensFocusesAsACountOfRaysSays) {
    Scene scene = load_scene("shape:sphere,segments=128");
    const double radius = double(scene_bounds(scene).half_size.x);
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    add(scene, floor_at(float(-1.6 * radius)), matt(0.0f));
    const std::vector<Photon> photons = photons_of(scene, 400000);
    const double width = 0.1;
    const auto expected = rings_below_ball(double(scene.materials[0].ior), 1.6, width, 20);
    std::vector<double> found(expected.size());
    for (const Photon& photon : photons) {
        const double rho = std::hypot(photon.position.x, photon.position.z) / radius / width;
        if (rho < double(found.size())) found[std::size_t(rho)] += double(photon.flux.g) / (radius * radius);
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double error = std::sqrt(3 * pi / 400000 * expected[i]);
        EXPECT_NEAR(found[i], expected[i], 4 * error + 0.01 * expected[i] + 1e-4) << "ring " << i;
    }
}

PathTraceSettings settings_of(std::uint32_t size, std::uint32_t samples, std::uint32_t photons) {
    return {.width = size, .height = size, .samples = samples, .photons = photons};
}

TEST(Photons, AFloorShowsTheCausticOfABallLens) {
    Scene scene = load_scene("shape:sphere,segments=128");
    const double radius = double(scene_bounds(scene).half_size.x);
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    add(scene, floor_at(float(-1.6 * radius)), matt(0.1f));
    const auto rings = rings_below_ball(double(scene.materials[0].ior), 1.6, 0.01, 60);
    for (const std::size_t ring : {15u, 30u, 45u}) {
        const double rho = (double(ring) + 0.5) * 0.01;
        double flux = 0.0;
        for (const std::size_t i : {ring - 1, ring, ring + 1}) flux += rings[i];
        const double irradiance = flux / (pi * 6 * rho * 0.01);
        const glm::vec3 target(0.0f, float(-1.6 * radius), float(rho * radius));
        const Camera camera =
            parallel_camera(target, glm::normalize(glm::vec3(-1, -0.1f, 0)), 1e-4f, float(3 * radius));
        const PathTracedImage image = Tracer(scene).path_trace(camera, uniform(0.0f), settings_of(1, 100, 20000));
        const double expected = 0.1 / pi * irradiance, error = double(image.standard_error.pixels[0]);
        EXPECT_NEAR(double(image.radiance.pixels[0]), expected, 4 * error + 0.02 * expected)
            << "at " << rho << " radii";
        EXPECT_LT(error, 0.1 * expected);
    }
}

TEST(Photons, MeansConvergeToTheLightThatArrives) {
    // A window of the floor below a plate: a kernel spreads light, but neither loses nor adds any.
    Scene scene = scene_of(with_flat_normals(cube(1.0f, {0, 3, 0})), glass());
    scene.lights = {sun({0, -1, 0}, 1.0f)};
    add(scene, floor_at(0.0f), matt(0.02f));
    const Camera camera = parallel_camera(glm::vec3(0), {0, -1, 0}, 1.5f, 1.0f);
    const double expected = 0.02 / pi * (1.5 * 1.5 - 1 + 2 * 1.5 / (1.5 * 1.5 + 1)) / (1.5 * 1.5);
    std::vector<double> errors;
    for (const std::uint32_t samples : {1u, 16u, 256u}) {
        const PathTracedImage image = Tracer(scene).path_trace(camera, uniform(0.0f), settings_of(16, samples, 2000));
        double mean = 0.0;
        for (const float value : image.radiance.pixels) mean += double(value) / double(image.radiance.pixels.size());
        errors.push_back(std::abs(mean / expected - 1));
    }
    EXPECT_LT(errors[0], 0.2);
    EXPECT_LT(errors[1], 0.03);
    EXPECT_LT(errors[2], 0.005);
}

TEST(Photons, LightStraightThroughPanesCountsOnce) {
    Material pane = glass();
    pane.thickness = 0.0f;
    Scene scene = scene_of(floor_at(0.0f), matt(0.5f));
    add(scene, floor_at(1.0f, 2.0f), pane);
    scene.lights = {lamp({0, 2, 0}, 3.0f), sun({0.1f, -1, 0}, 3.0f)};
    const Camera camera = parallel_camera(glm::vec3(0), {0, -1, 0}, 1.0f, 0.5f);
    const auto trace_with = [&](std::uint32_t photons) {
        return Tracer(scene).path_trace(camera, uniform(0.0f), settings_of(8, 4, photons)).radiance.pixels;
    };
    EXPECT_EQ(trace_with(5000), trace_with(0));
    EXPECT_TRUE(photons_of(scene, 5000).empty());
}

TEST(Photons, APaneMirrorsALampOntoTheFloor) {
    Material pane = glass();
    pane.thickness = 0.0f;
    Scene scene = scene_of(floor_at(0.0f), matt(0.02f));
    add(scene, square(), pane,
        glm::translate(glm::mat4(1.0f), glm::vec3(0, 1.01f, 0)) *
            glm::rotate(glm::mat4(1.0f), 1.5707963f, glm::vec3(0, 1, 0)));
    scene.lights = {lamp({2, 2, 0}, 3.0f)};
    const Camera camera = parallel_camera({1, 0, 0}, {0, -1, 0}, 0.01f);
    const PathTracedImage image = Tracer(scene).path_trace(camera, uniform(0.0f), settings_of(1, 2000, 4000));
    const double cosine = 3 / std::sqrt(13.0), f = incidence({0, 0, -cosine}, {0, 0, 1}, 1.0, 1.5).reflectance;
    const auto irradiance = [](double distance2) { return 3.0 / distance2 * 2 / std::sqrt(distance2); };
    const double direct = 0.02 / pi * irradiance(5), mirrored = 0.02 / pi * irradiance(13) * 2 * f / (1 + f);
    const double error = double(image.standard_error.pixels[0]);
    EXPECT_NEAR(double(image.radiance.pixels[0]) - direct, mirrored, 4 * error + 0.01 * mirrored);
    EXPECT_LT(error, 0.15 * mirrored);
}

TEST(Photons, AnEmissiveBallIsALampOfItsSize) {
    // Photons have the lamp's light behind glass, and chance that of the emissive ball.
    Scene scene = load_scene("shape:sphere,segments=128");
    add(scene, floor_at(-1.6f, 2.0f), matt(0.1f));
    const Camera camera = parallel_camera({0, -1.6f, 0}, {0, -1, 0}, 1.2f, 0.3f);
    const auto mean = [&](const Scene& lit, std::uint32_t samples, std::uint32_t photons) {
        return mean_of(trace_picture(lit, camera, 0.0f, 16, samples, photons));
    };
    const float radius = 0.4f, intensity = 5.0f;
    Scene by_lamp = scene, by_surface = scene;
    by_lamp.lights = {lamp({0.2f, 3.0f, 0.1f}, intensity, radius)};
    Mesh shell = load_scene("shape:sphere,segments=128").meshes[0];
    for (glm::vec3& p : shell.positions) p *= radius / glm::length(p);
    Material bright = matt(0.0f);
    bright.emission = glm::vec3(intensity / (float(pi) * radius * radius));
    add(by_surface, shell, bright, glm::translate(glm::mat4(1.0f), glm::vec3(0.2f, 3.0f, 0.1f)));
    const Seen lamp_seen = mean(by_lamp, 64, 4000), surface_seen = mean(by_surface, 1000, 4000);
    EXPECT_NEAR(surface_seen.radiance, lamp_seen.radiance, 0.02 * lamp_seen.radiance);
    EXPECT_LT(surface_seen.error, 0.015 * lamp_seen.radiance);
}

TEST(Photons, WhatLiesInGlassShowsTheLightThatComesIn) {
    // Radiance falls by n^2 on its way out, where the base colour tints it: not on the way in, too.
    Scene scene = scene_of(floor_at(0.0f, 0.4f), matt(0.002f));
    add(scene, with_flat_normals(cube()), glass());
    scene.materials[1].base_color = {0.5f, 0.5f, 0.5f, 1.0f};
    scene.lights = {sun({0, -1, 0}, 3.0f)};
    const Camera camera = parallel_camera({0.1f, 0, 0.1f}, {0, -1, 0}, 1e-3f);
    const PathTracedImage image = Tracer(scene).path_trace(camera, uniform(0.0f), settings_of(1, 1000, 1000));
    const double expected = 0.5 * 0.002 / pi * 3 * 0.96 * 0.96 / 2.25, error = double(image.standard_error.pixels[0]);
    EXPECT_NEAR(double(image.radiance.pixels[0]), expected, 4 * error + 0.005 * expected);
    EXPECT_LT(error, 0.05 * expected);
}

TEST(Photons, PicturesDependOnNeitherThreadsNorPortions) {
    Scene scene = load_scene("shape:sphere,segments=16");
    add(scene, floor_at(-1.5f, 2.0f), matt(0.5f));
    scene.lights = {sun({0.2f, -1, 0}, 3.0f), lamp({1, 3, 0}, 3.0f)};
    const auto trace_on = [&](std::uint32_t threads, std::uint32_t first, std::uint32_t samples) {
        PathTraceSettings settings = settings_of(20, samples, 60000);
        settings.first_sample = first;
        return Tracer(scene, {.threads = threads})
            .path_trace(view_of(scene, 10), uniform(0.1f), settings)
            .radiance.pixels;
    };
    const std::vector<float> whole = trace_on(1, 0, 2), first = trace_on(2, 0, 1), second = trace_on(2, 1, 1);
    EXPECT_EQ(whole, trace_on(2, 0, 2));
    for (std::size_t i = 0; i < whole.size(); ++i)
        EXPECT_NEAR(whole[i], 0.5f * (first[i] + second[i]), 1e-5f * (1.0f + whole[i]));
}

}  // namespace
}  // namespace pellucid::reference
