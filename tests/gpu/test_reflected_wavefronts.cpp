// What surfaces in volumes do with light: it is taken away, or followed where it is reflected to.
#include "lab/landed_light.h"
#include "optics/index_fields.h"
#include "optics/interface.h"

#include "gpu/wavefront_test.h"

#include <algorithm>
#include <numbers>

namespace pellucid::test {
namespace {

constexpr float kSlabEdge = 1.5f;   // of the box
constexpr float kSlabHalf = 0.4f;   // of the slab's thickness
constexpr unsigned kSlabSize = 48;  // voxels

/// A level slab whose surfaces are smoothed by 0.7 voxel, out through the sides of its box.
Volume slab(float ior) {
    Volume slab = block(kSlabSize, kSlabEdge, 1.0f, glm::vec3(0.0f));
    slab.boundary.resize(slab.voxel_count());
    const float sigma = 0.7f * slab.voxel;
    for (std::size_t i = 0; i < slab.voxel_count(); ++i) {
        const float y = slab.low.y + (float(i / kSlabSize % kSlabSize) + 0.5f) * slab.voxel;
        const float off = std::abs(y) - kSlabHalf;
        slab.n[i] = 1.0f + (ior - 1.0f) * smoothed_inside(off, sigma);
        slab.boundary[i] = std::exp(-0.5f * off * off / (sigma * sigma));
    }
    return slab;
}

LightSettings with_reflections(std::uint32_t count) {
    LightSettings settings;
    settings.reflections = count;
    return settings;
}

double accounted(const LightStatistics& s) {
    return s.arrived.x + s.missed.x + s.absorbed.x + s.reflected.x + s.turned.x + s.weak.x + s.left.x;
}

TEST_F(Wavefront, SurfacesTakeAwayWhatTheyReflect) {
    Scene scene;
    place(scene, slab(1.5f));
    add_plane(scene, {0.0f, -2.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(scene, with_reflections(0));
    print("slab", tracer().statistics());
    // Twice 4% at normal incidence, within the bar of view rays.
    const double expected = 1.5 * 1.5 * 0.96 * 0.96;
    EXPECT_NEAR(power_on_objects().x, expected, 0.005 * expected);
    EXPECT_NEAR(tracer().statistics().reflected.x, 1.5 * 1.5 - expected, 0.005 * expected);
    scene.lights = {directional({0.5f, -1.0f, 0.0f})};
    trace(scene, with_reflections(0));
    const LightStatistics& s = tracer().statistics();
    EXPECT_NEAR(s.reflected.x + s.arrived.x + s.missed.x + s.left.x, s.emitted.x, 1e-4);
}

// Between two surfaces light is reflected again and again: on the whole 2 R / (1 + R) returns and (1 - R) / (1 + R) passes.
TEST_F(Wavefront, SlabsReflectAsFresnelSays) {
    for (const float ior : {1.5f, 2.42f}) {
        Scene scene;
        place(scene, slab(ior));
        for (const float y : {2.0f, -2.0f})  // above and below
            add_plane(scene, {0.0f, y, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
        scene.lights = {directional({0.0f, -1.0f, 0.0f})};
        const double all = double(kSlabEdge) * double(kSlabEdge), r = fresnel_dielectric(1.0, 1.0 / double(ior));
        const double t = 1.0 - r;
        double returned = r, passed = t * t;  // at first
        for (std::uint32_t reflections = 1; reflections <= 3; ++reflections) {
            // What has been reflected `reflections` times inside leaves above or below in turn.
            const double more = t * t * std::pow(r, double(reflections));
            (reflections % 2 == 1 ? returned : passed) += more;
            trace(scene, with_reflections(reflections));
            const LightStatistics s = tracer().statistics();
            print("slab", s);
            const double above = power_on_objects(0).x, below = power_on_objects(1).x;
            std::printf(
                "index %.2f, %u reflections: returned %.5f, expected %.5f, in all %.5f; passed %.5f, expected "
                "%.5f, in all %.5f\n",
                double(ior), reflections, above / all, returned, 2.0 * r / (1.0 + r), below / all, passed,
                t / (1.0 + r));
            EXPECT_NEAR(above / all, returned, 0.01 * returned);
            EXPECT_NEAR(below / all, passed, 0.01 * passed);
            EXPECT_NEAR(accounted(s), s.emitted.x, 0.001 * s.emitted.x);
            if (reflections > 1) continue;
            // Light in voxels, before and behind the slab, away from its surfaces and from the sides.
            const std::vector<glm::vec4> light = voxel_light();
            for (const auto& [y, expected] : {std::pair(44u, 1.0 + returned), std::pair(4u, passed)}) {
                double sum = 0.0;
                for (unsigned z = 12; z < 36; ++z)
                    for (unsigned x = 12; x < 36; ++x) sum += double(light[x + kSlabSize * (y + kSlabSize * z)].x);
                EXPECT_NEAR(sum / (24.0 * 24.0), expected, 0.01 * expected) << y;
            }
        }
    }
}

// A narrow cone of light at 45 degrees: how much of it a plane above gets, and where.
TEST_F(Wavefront, SlantedLightIsMirroredBySlabs) {
    Scene scene;
    place(scene, slab(1.5f));
    add_plane(scene, {2.0f, 2.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    Light spot = point({-1.9f, 1.5f + kSlabHalf, 0.0f});  // meets the upper surface at x = -0.4
    spot.kind = Light::Kind::kSpot;
    spot.direction = glm::normalize(glm::vec3(1.0f, -1.0f, 0.0f));
    spot.inner_cone_angle = 0.03f;
    spot.outer_cone_angle = 0.06f;
    scene.lights = {spot};
    LightSettings settings = with_reflections(1);
    settings.finest = 1e-4f;  // the edge of the cone is faint
    trace(scene, settings);
    const LightStatistics s = tracer().statistics();
    print("slanted", s);
    EXPECT_NEAR(accounted(s), s.emitted.x, 0.001 * s.emitted.x);
    const double r = fresnel_dielectric(std::sqrt(0.5), 1.0 / 1.5);
    const double upper = r * s.emitted.x, lower = (1.0 - r) * (1.0 - r) * upper;
    // By the lower surface the way across the slab is twice its thickness times the tangent of the refracted angle.
    const double sine = std::sqrt(0.5) / 1.5, apart = 4.0 * double(kSlabHalf) * sine / std::sqrt(1.0 - sine * sine);
    const double x = 2.0 - double(kSlabHalf) - 0.4;
    const double voxel = double(scene.volumes[0]->voxel);
    glm::dvec2 of_upper(0.0), of_lower(0.0);  // power, and its mean x
    for (const LandedPhoton& photon : photons())
        (photon.position.x < x + 0.5 * apart ? of_upper : of_lower) +=
            photon.flux.x * glm::dvec2(1.0, photon.position.x);
    of_upper.y /= of_upper.x;
    of_lower.y /= of_lower.x;
    std::printf("slanted: power %.5f and %.5f, expected %.5f and %.5f; at %.4f and %.4f, expected %.4f and %.4f\n",
                of_upper.x, of_lower.x, upper, lower, of_upper.y, of_lower.y, x, x + apart);
    // Incidence differs by 3 degrees across the cone, over which Fresnel's formula rises by 8%.
    EXPECT_NEAR(of_upper.x, upper, 0.02 * upper);
    EXPECT_NEAR(of_lower.x, lower, 0.02 * lower);
    EXPECT_NEAR(of_upper.y, x, 0.5 * voxel);
    EXPECT_NEAR(of_lower.y, x + apart, 0.5 * voxel);
}

/// Of parallel light downwards on a unit sphere of index 1.5: power that the upper part of the plane x = `distance` gets,
/// `low` < y < `high`, |z| < `distance`, and its mean y. All of it is reflected by the sphere's outside: what passes the
/// sphere is deviated by 96 degrees at most, what is reflected inside by 157 or more.
glm::dvec2 beside_sphere(double distance, double low, double high, double wide) {
    glm::dvec2 sums(0.0);
    const int rings = 4000, around = 720;
    for (int i = 0; i < rings; ++i) {
        const double b = (i + 0.5) / rings, r = fresnel_dielectric(std::sqrt(1.0 - b * b), 1.0 / 1.5);
        for (int k = 0; k < around; ++k) {
            const double phi = 2.0 * std::numbers::pi * (k + 0.5) / around;
            const glm::dvec3 x(b * std::cos(phi), std::sqrt(1.0 - b * b), b * std::sin(phi));
            const glm::dvec3 way = reflect_direction(glm::dvec3(0.0, -1.0, 0.0), x);
            if (way.x <= 0.0) continue;
            const glm::dvec3 at = x + (distance - x.x) / way.x * way;
            if (at.y < low || at.y > high || std::abs(at.z) > wide) continue;
            sums += glm::dvec2(1.0, at.y) * (2.0 * std::numbers::pi * b * r / rings / around);
        }
    }
    return {sums.x, sums.y / sums.x};
}

// In the middle of the ball all light is absorbed, so that none comes back out of it. The smoothed surface is 4 voxels thick:
// the ball reflects as one that is larger by a fraction of a voxel (3% more light at 96 voxels).
TEST_F(Wavefront, BallsAreMirrors) {
    Scene scene;
    Volume ball = make_volume("smoothed-sphere,radius=1,resolution=96");
    ball.sigma_a.assign(ball.voxel_count(), glm::vec3(0.0f));
    for (std::size_t i = 0; i < ball.voxel_count(); ++i) {
        const glm::uvec3 at(i % ball.size.x, i / ball.size.x % ball.size.y, i / ball.size.x / ball.size.y);
        if (glm::length(ball.low + (glm::vec3(at) + 0.5f) * ball.voxel) < 0.85f) ball.sigma_a[i] = glm::vec3(50.0f);
    }
    place(scene, std::move(ball));
    const double distance = 3.0, low = 1.0, high = 2.5, wide = 1.0;
    add_plane(scene, {3.0f, 1.75f, 0.0f}, {0.0f, 0.75f, 0.0f}, {0.0f, 0.0f, 1.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(scene, with_reflections(1));
    const LightStatistics s = tracer().statistics();
    print("ball", s);
    EXPECT_NEAR(accounted(s), s.emitted.x, 0.001 * s.emitted.x);
    glm::dvec2 found(0.0);  // power, and its mean height
    for (const LandedPhoton& photon : photons()) found += photon.flux.x * glm::dvec2(1.0, photon.position.y);
    found.y /= found.x;
    BallAndPlane plane{.corner = {distance, low, -wide}, .side = {0, 0, 1}, .up = {0, 1, 0}};
    plane.texel = double(scene.volumes[0]->voxel);
    plane.width = int(2.0 * wide / plane.texel);
    plane.height = int((high - low) / plane.texel);
    const std::vector<double> map = landed_map(photons(), plane);
    const auto dark = std::size_t(std::count(map.begin(), map.end(), 0.0));
    std::printf("ball: %zu of %zu texels are dark\n", dark, map.size());
    EXPECT_LT(dark, map.size() / 50);  // each corner is mirrored by itself, so that patches fit together
    const glm::dvec2 expected = beside_sphere(distance, low, high, wide);
    std::printf("ball: reflected beside it %.5f W, expected %.5f; mean height %.4f, expected %.4f\n", found.x,
                expected.x, found.y, expected.y);
    EXPECT_NEAR(found.x, expected.x, 0.05 * expected.x);
    EXPECT_NEAR(found.y, expected.y, 0.02);
}

TEST_F(Wavefront, MirroredPatchesHaveNotTurnedOverAndNeedRoom) {
    Scene scene;
    place(scene, slab(1.5f));
    add_plane(scene, {0.0f, 2.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    LightSettings settings = with_reflections(1);
    settings.keep_folds = false;
    const double expected = 0.04 * (1.0 + 0.96 * 0.96) * double(kSlabEdge) * double(kSlabEdge);
    LightStatistics s = trace(scene, settings);
    EXPECT_EQ(s.turned.x, 0.0);
    EXPECT_NEAR(power_on_objects().x, expected, 0.01 * expected);
    EXPECT_TRUE(s.warnings().empty());

    settings.capacity = 3000;  // 2,601 patches begin
    s = trace(scene, settings);
    print("want of room", s);
    EXPECT_GT(s.refused, 2000u);
    EXPECT_NEAR(accounted(s), s.emitted.x, 0.001 * s.emitted.x);
    EXPECT_LT(power_on_objects().x, 0.5 * expected);
    ASSERT_EQ(s.warnings().size(), 1u);
    EXPECT_NE(s.warnings()[0].find("reflections of patches found no room"), std::string::npos) << s.warnings()[0];
}

}  // namespace
}  // namespace pellucid::test
