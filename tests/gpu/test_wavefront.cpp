// Light through volumes on the device: power, the inverse square, caustics, folds, and what is reported.
#include "lab/landed_light.h"
#include "optics/index_fields.h"
#include "optics/phase.h"

#include "gpu/wavefront_test.h"
#include "gpu_tests/shaders.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <numbers>

namespace pellucid::test {
namespace {

// 1%: the bar for power. What is emitted is known beforehand, so that neither side is the tracer's own word.
TEST_F(Wavefront, PowerOnEnclosingPlanesIsThePowerEmitted) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=48,radius=1"));
    const float edge = 2.0f * scene.volumes[0]->high().x;
    enclose(scene, 2.5f);
    scene.lights = {directional({0.0f, -1.0f, 0.0f}, {2.0f, 1.0f, 0.5f})};
    trace(scene, without_reflection());
    print("directional", tracer().statistics());
    const double flux = 2.0 * double(edge) * double(edge);
    glm::dvec3 arrived = power_on_objects();
    EXPECT_NEAR(arrived.x, flux, 0.01 * flux);
    EXPECT_NEAR(arrived.y, 0.5 * flux, 0.005 * flux);
    EXPECT_NEAR(arrived.z, 0.25 * flux, 0.0025 * flux);
    EXPECT_TRUE(tracer().statistics().warnings().empty());

    scene.lights = {point({0.2f, 0.3f, -0.1f})};  // inside: all of it meets the volume
    trace(scene, without_reflection());
    print("point inside", tracer().statistics());
    arrived = power_on_objects();
    EXPECT_NEAR(arrived.x, 4.0 * std::numbers::pi, 0.01 * 4.0 * std::numbers::pi);

    scene.lights = {point({0.0f, 2.0f, 0.0f})};  // outside: what a face of the box takes of it
    trace(scene, without_reflection());
    print("point outside", tracer().statistics());
    const double a = 0.5 * double(edge), d = 2.0 - a;
    const double solid_angle = 4.0 * std::asin(a * a / (a * a + d * d));
    arrived = power_on_objects();
    EXPECT_NEAR(arrived.x, solid_angle, 0.01 * solid_angle);
}

TEST_F(Wavefront, AbsorptionFollowsBeerAndLambert) {
    Scene scene;
    const glm::vec3 sigma(0.5f, 1.0f, 2.0f);
    place(scene, block(48, 1.5f, 1.4f, sigma));
    enclose(scene, 2.0f);
    scene.lights = {directional({0.0f, 0.0f, 1.0f})};
    trace(scene);
    print("block", tracer().statistics());
    const glm::dvec3 arrived = power_on_objects();
    for (int c = 0; c < 3; ++c) {
        const double expected = 1.5 * 1.5 * std::exp(-double(sigma[c]) * 1.5);
        EXPECT_NEAR(arrived[c], expected, 0.01 * expected) << c;
    }
}

// The bar of 1% holds for means over cells of 4 x 4 x 4 voxels of the sum; a voxel of it is held to the 1.5% by which grids of
// points two to a voxel scatter, times four. The brightest light is that of some patch: somewhere in the voxel, not in its middle.
TEST_F(Wavefront, PointLightFollowsTheInverseSquareLaw) {
    Scene scene;
    place(scene, block(64, 2.0f, 1.3f, glm::vec3(0.0f)));
    const glm::dvec3 lamp(0.01);
    scene.lights = {point(glm::vec3(lamp), glm::vec3(3.0f))};
    for (const KeptLight kept : {KeptLight::kSum, KeptLight::kBrightest}) {
        const bool sums = kept == KeptLight::kSum;
        if (!sums && !device().long_atomics()) continue;
        LightSettings settings;
        settings.kept = kept;
        trace(scene, settings);
        print("inverse square", tracer().statistics());
        const std::vector<glm::vec4> light = voxel_light();
        double worst = 0.0, sum = 0.0, squares = 0.0, worst_cell = 0.0;
        int lit = 0, dark = 0;
        std::vector<glm::dvec2> cells(16 * 16 * 16, glm::dvec2(0.0));
        for (int z = 0, i = 0; z < 64; ++z)
            for (int y = 0; y < 64; ++y)
                for (int x = 0; x < 64; ++x, ++i) {
                    const double r = 1.0 / 32.0 * glm::distance(glm::dvec3(x, y, z) + 0.5 - 32.0, 32.0 * lamp);
                    if (r < 4.0 / 32.0 || r > 0.95) continue;
                    const double found = double(light[std::size_t(i)].x), ratio = found * r * r / 3.0;
                    ++(found > 0.0 ? lit : dark);
                    cells[std::size_t(x / 4 + 16 * (y / 4 + 16 * (z / 4)))] += glm::dvec2(ratio, 1.0);
                    worst = std::max(worst, std::abs(ratio - 1.0));
                    squares += (ratio - 1.0) * (ratio - 1.0);
                    EXPECT_LT(std::abs(ratio - 1.0), sums ? 0.3 : 0.03 + 2.0 * (0.87 / 32.0) / r);
                    sum += ratio;
                }
        for (const glm::dvec2 cell : cells)
            if (cell.y == 64.0) worst_cell = std::max(worst_cell, std::abs(cell.x / cell.y - 1.0));
        std::printf("inverse square, %s: mean %.4f, rms %.4f, worst %.4f, worst cell %.4f, dark %d of %d\n",
                    sums ? "sum" : "brightest", sum / lit, std::sqrt(squares / lit), worst, worst_cell, dark,
                    lit + dark);
        EXPECT_NEAR(sum / lit, 1.0, sums ? 0.01 : 0.03);
        EXPECT_EQ(dark, 0);
        EXPECT_LT(worst_cell, sums ? 0.01 : 0.1);
        EXPECT_LT(std::sqrt(squares / lit), 0.04);
    }
}

// The light behind a ball against photons through the same smoothed ball, at least 1,000 in every voxel that counts.
TEST_F(Wavefront, SumsBehindABallAreThoseOfCountedPhotons) {
    Scene scene;
    const unsigned resolution = 96, per_voxel = 32;
    Volume ball = block(resolution, 3.2f, 1.0f, glm::vec3(0.0f));
    const double voxel = double(ball.voxel);
    const BallAndPlane truth{
        .smoothing = 0.75 * voxel, .box = 1.6, .direction = glm::normalize(glm::dvec3(0.2, -1.0, 0.1))};
    for (unsigned z = 0, i = 0; z < resolution; ++z)
        for (unsigned y = 0; y < resolution; ++y)
            for (unsigned x = 0; x < resolution; ++x, ++i) {
                const double r = glm::length((glm::dvec3(x, y, z) + 0.5) * voxel - truth.box);
                ball.n[i] = 1.0f + 0.5f * float(smoothed_inside(r - truth.radius, truth.smoothing));
            }
    place(scene, ball);
    scene.lights = {directional(glm::vec3(truth.direction))};
    trace(scene, without_reflection());
    const VoxelPhotons photons = count_voxel_photons(truth, resolution, per_voxel);
    const std::vector<glm::vec4> light = voxel_light();
    std::vector<double> own, exact;
    double apart = 0.0, total = 0.0, found = 0.0;
    for (unsigned z = 0, i = 0; z < resolution; ++z)
        for (unsigned y = 0; y < resolution; ++y)
            for (unsigned x = 0; x < resolution; ++x, ++i) {
                const glm::dvec3 at = (glm::dvec3(x, y, z) + 0.5) * voxel - truth.box;
                if (glm::length(at) < truth.radius + 5.0 * truth.smoothing + voxel) continue;
                if (glm::dot(at, truth.direction) < 0.0 || photons.photons[std::size_t(i)] < 1000.0) continue;
                own.push_back(double(light[std::size_t(i)].x));
                exact.push_back(photons.fluence[std::size_t(i)]);
                apart += std::abs(own.back() - exact.back());
                total += exact.back();
                found += own.back();
            }
    std::printf("behind a ball: %zu voxels, correlation %.4f, flux %.4f, apart %.4f\n", own.size(),
                correlation(own, exact), found / total, apart / total);
    EXPECT_GT(own.size(), 1000u);
    EXPECT_GT(correlation(own, exact), 0.97);
    EXPECT_NEAR(found / total, 1.0, 0.01);
    EXPECT_LT(apart / total, 0.15);
}

TEST_F(Wavefront, CausticOfABallIsThatOfCountedPhotons) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=128,radius=1"));
    add_plane(scene, {0.0f, -1.5f, 0.0f}, {2.5f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.5f});
    scene.lights = {directional({0.2f, -1.0f, 0.1f})};
    trace(scene, without_reflection());
    print("caustic", tracer().statistics());
    std::printf("caustic: traced in %.0f ms\n", time_ms());
    const double voxel = double(scene.volumes[0]->voxel);
    BallAndPlane truth{.smoothing = 0.75 * voxel,
                       .box = double(scene.volumes[0]->high().x),
                       .direction = glm::normalize(glm::dvec3(0.2, -1.0, 0.1))};
    set_level_map(truth, 2.5, -1.5, voxel);
    const std::vector<double> own = landed_map(photons(), truth);
    const std::vector<double> exact = count_photons(truth, 2500);
    // What the ball has bent: around the middle of its shadow.
    const glm::dvec3 foot = -1.5 / truth.direction.y * truth.direction - truth.corner;
    const glm::dvec2 around = glm::dvec2(glm::dot(foot, truth.side), glm::dot(foot, truth.up)) / truth.texel;
    const CausticSpot spot = caustic_spot(own, truth.width, around, 0.9 / truth.texel),
                      wanted = caustic_spot(exact, truth.width, around, 0.9 / truth.texel);
    const double voxels = truth.texel / voxel, alike = correlation(own, exact);
    std::printf("caustic: centre %.3f voxels off, half-power radius %.3f, exact %.3f voxels, correlation %.4f\n",
                voxels * glm::distance(spot.center, wanted.center), voxels * spot.radius, voxels * wanted.radius,
                alike);
    double apart = 0.0, total = 0.0, found = 0.0;
    for (std::size_t i = 0; i < own.size(); ++i) {
        apart += std::abs(own[i] - exact[i]);
        total += exact[i];
        found += own[i];
    }
    std::printf("caustic: flux %.4f, apart %.4f\n", found / total, apart / total);
    EXPECT_LT(voxels * glm::distance(spot.center, wanted.center), 1.0);
    EXPECT_NEAR(voxels * spot.radius, voxels * wanted.radius, 1.0);
    EXPECT_GT(alike, 0.97);
    EXPECT_NEAR(found / total, 1.0, 0.01);
    EXPECT_LT(apart / total, 0.15);
    EXPECT_GT(voxels * wanted.radius, 2.0);  // else the bars would say little
}

// A ball of index 3 has its focus inside, at three quarters of its radius.
TEST_F(Wavefront, LightGoesOnPastAFocusIfFoldsAreKept) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=48,radius=1,ior=3"));
    enclose(scene, 2.5f);
    scene.lights = {directional({0.0f, 0.0f, 1.0f})};
    // Around the axis, behind the ball.
    const auto beyond = [&] {
        double sum = 0.0;
        const std::vector<glm::vec4> light = voxel_light();
        for (std::size_t y = 14; y < 34; ++y)
            for (std::size_t x = 14; x < 34; ++x) sum += double(light[x + 48 * (y + 48 * 46)].x);
        return sum;
    };
    LightSettings settings = without_reflection();
    trace(scene, settings);
    print("kept", tracer().statistics());
    const LightStatistics kept = tracer().statistics();
    EXPECT_EQ(kept.turned.x, 0.0);
    const double kept_beyond = beyond();
    EXPECT_GT(kept_beyond, 100.0);
    const double on_planes = power_on_objects().x;
    EXPECT_NEAR(on_planes, kept.emitted.x - kept.left.x, 0.01 * kept.emitted.x);

    settings.keep_folds = false;
    trace(scene, settings);
    print("dropped", tracer().statistics());
    const LightStatistics dropped = tracer().statistics();
    EXPECT_EQ(dropped.emitted, kept.emitted);
    std::printf("beyond the focus: kept %.1f, dropped %.1f\n", kept_beyond, beyond());
    EXPECT_LT(beyond(), 0.3 * kept_beyond);  // near the axis patches are past the focus before they turn over
    EXPECT_GT(dropped.turned.x, 0.3 * dropped.emitted.x);
    EXPECT_NEAR(power_on_objects().x, dropped.emitted.x - dropped.turned.x - dropped.left.x, 0.01 * dropped.emitted.x);
}

TEST_F(Wavefront, WantOfRoomIsReportedAndLosesNoLight) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=48,radius=1"));
    enclose(scene, 2.5f);
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    LightSettings settings = without_reflection();
    for (const std::uint32_t capacity : {3000u, 500u}) {  // 2,704 patches begin
        settings.capacity = capacity;
        const LightStatistics& s = trace(scene, settings);
        print("want of room", s);
        EXPECT_LE(s.patches, capacity);
        EXPECT_GT(s.refused, 0u);
        EXPECT_EQ(s.coarsened, capacity == 500u);
        ASSERT_FALSE(s.warnings().empty());
        EXPECT_NE(s.warnings()[0].find("found no room"), std::string::npos) << s.warnings()[0];
        // Patches that are not split straddle edges: a few ends of a patch are far apart.
        EXPECT_NEAR(power_on_objects().x + s.missed.x + s.left.x, s.emitted.x, 0.001 * s.emitted.x);
        EXPECT_NEAR(power_on_objects().x, s.emitted.x, 0.03 * s.emitted.x);
    }
    settings = without_reflection();
    settings.rounds = 5;
    const LightStatistics& s = trace(scene, settings);
    EXPECT_GT(s.left.x, 0.5 * s.emitted.x);
    EXPECT_GT(s.patches_left, 0u);
    ASSERT_EQ(s.warnings().size(), 1u);
    EXPECT_NE(s.warnings()[0].find("still on their way after 5 rounds"), std::string::npos) << s.warnings()[0];
}

TEST_F(Wavefront, MovedLightIsTracedAgainAndOnlyThen) {
    Scene scene;
    place(scene, block(16, 1.0f, 1.0f, glm::vec3(0.0f)));
    add_plane(scene, {0.0f, -1.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(scene);
    const auto middle = [&] {  // of the light on the plane, world
        glm::dvec3 sum(0.0);
        double power = 0.0;
        for (const LandedPhoton& photon : photons()) {
            sum += photon.flux.x * photon.position;
            power += photon.flux.x;
        }
        return sum / power;
    };
    EXPECT_LT(glm::distance(middle(), glm::dvec3(0.0, -1.0, 0.0)), 0.01);
    EXPECT_FALSE(tracer().update(recorder(), workspace(), scene, volumes(), {}));
    scene.lights[0].direction = glm::normalize(glm::vec3(0.5f, -1.0f, 0.0f));
    update(scene);
    EXPECT_LT(glm::distance(middle(), glm::dvec3(0.5, -1.0, 0.0)), 0.01);
    scene.objects[0].world_from_object = glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -1.0f, 0.0f));
    update(scene);
    EXPECT_LT(glm::distance(middle(), glm::dvec3(1.0, -2.0, 0.0)), 0.01);
}

// One behind the other, in other frames; and a small one in a large one, where the small one counts.
TEST_F(Wavefront, SeveralVolumesAbsorbInTurn) {
    Scene scene;
    glm::mat4 mirrored = glm::scale(glm::mat4(1.0f), glm::vec3(-0.5f, 0.5f, 0.5f));
    mirrored[3] = glm::vec4(0.0f, -1.0f, 0.0f, 1.0f);
    const glm::mat4 turned = glm::rotate(glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 1.0f, 0.0f)),
                                         std::numbers::pi_v<float> / 2.0f, glm::vec3(0.0f, 0.0f, 1.0f));
    place(scene, block(24, 1.0f, 1.2f, glm::vec3(0.6f)), turned);
    place(scene, block(32, 2.0f, 1.1f, glm::vec3(0.4f)), mirrored);  // edge 1, sigma_a 0.4 in the world as well
    add_plane(scene, {0.0f, -3.0f, 0.0f}, {1.5f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.5f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(scene);
    print("in a row", tracer().statistics());
    // Lengths count in voxels of the volume: scaled to a half it has half of the optical depth that it was made with, 0.8.
    const double in_a_row = std::exp(-0.6 - 0.8);
    EXPECT_NEAR(power_on_objects().x, in_a_row, 0.01 * in_a_row);

    Scene nested;
    place(nested, block(24, 2.0f, 1.0f, glm::vec3(0.3f)));
    place(nested, block(16, 1.0f, 1.3f, glm::vec3(1.0f)));
    add_plane(nested, {0.0f, -3.0f, 0.0f}, {1.5f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.5f});
    nested.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(nested);
    print("nested", tracer().statistics());
    const double beside = 3.0 * std::exp(-0.6), through = std::exp(-0.3 - 1.0);
    EXPECT_NEAR(power_on_objects().x, beside + through, 0.01 * (beside + through));
}

TEST_F(Wavefront, VoxelsKnowTheWayOfTheLightInTheirFrame) {
    Scene scene;
    const glm::mat4 placed = glm::rotate(glm::scale(glm::mat4(1.0f), glm::vec3(2.0f, 2.0f, -2.0f)), 0.7f,
                                         glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f)));
    place(scene, block(16, 1.0f, 1.5f, glm::vec3(0.0f)), placed);
    const glm::vec3 way = glm::normalize(glm::vec3(1.0f, -2.0f, 0.5f));
    scene.lights = {directional(way, {2.0f, 1.0f, 0.0f})};
    const glm::vec3 expected = glm::normalize(glm::inverse(glm::mat3(placed)) * way);
    for (const KeptLight kept : {KeptLight::kSum, KeptLight::kBrightest}) {
        const bool sums = kept == KeptLight::kSum;
        if (!sums && !device().long_atomics()) continue;
        LightSettings settings;
        settings.kept = kept;
        trace(scene, settings);
        const std::vector<std::byte> bytes = download_box(device(), tracer().light().direction);
        std::vector<std::uint64_t> directions(bytes.size() / 8);
        std::memcpy(directions.data(), bytes.data(), bytes.size());
        const std::vector<glm::vec4> light = voxel_light();
        // Brightest: 8 bits of colour, 24 of brightness, 12 and half floats of direction; along the edges of what meets the
        // box, patches have less: as much less as of them passes it. Sums scatter by 1.5% (points two to a voxel), more
        // where the corners of the box cut patches.
        std::size_t full = 0, dark = 0, astray = 0;
        double total = 0.0;
        for (std::size_t i = 0; i < light.size(); ++i) {
            const double share = double(light[i].x) / 2.0;
            total += share;
            dark += share == 0.0 ? 1 : 0;
            full += std::abs(share - 1.0) < (sums ? 0.05 : 0.005) ? 1 : 0;
            EXPECT_LT(share, sums ? 1.25 : 1.005);
            EXPECT_NEAR(light[i].y, 0.5f * light[i].x, 0.01f);
            EXPECT_NEAR(light[i].z, 0.0f, 0.01f);
            const glm::vec3 found(glm::unpackHalf4x16(directions[i]));
            astray += share > 0.0 && !(glm::distance(found, expected) < 2e-3f) ? 1 : 0;
        }
        std::printf("voxels: %zu, full light %zu, dark %zu, mean %.4f\n", light.size(), full, dark,
                    total / double(light.size()));
        EXPECT_EQ(astray, 0u);
        EXPECT_LT(dark, light.size() / 100);  // at the edges, where none is on both sides
        EXPECT_GT(full, light.size() * 9 / 10);
        EXPECT_NEAR(total / double(light.size()), 1.0, 0.01);
    }
}

// Every colour goes its own way: as through a volume of that colour's index alone. What differs are last digits.
TEST_F(Wavefront, ColorsPartInDispersiveVolumes) {
    const Volume dispersive = make_volume("smoothed-sphere,resolution=48,dispersion=4");
    const auto light_through = [&](const Volume& volume) {
        Scene scene;
        place(scene, volume);
        add_plane(scene, {0.0f, -1.4f, 0.0f}, {2.5f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.5f});
        scene.lights = {directional({0.1f, -1.0f, 0.0f}, {1.0f, 2.0f, 0.5f})};
        trace(scene);
        BallAndPlane plane;
        set_level_map(plane, 2.5, -1.4, double(volume.voxel));
        const std::vector<LandedPhoton> landed = photons();
        std::vector<std::vector<double>> colors;
        for (int c = 0; c < 3; ++c) colors.push_back(landed_map(landed, plane, c));
        return colors;
    };
    const std::vector<std::vector<double>> together = light_through(dispersive);
    const std::vector<float>* indices[] = {&dispersive.n_red, &dispersive.n, &dispersive.n_blue};
    double parts = 0.0;
    for (int c = 0; c < 3; ++c) {
        Volume plain = dispersive;
        plain.n = *indices[c];
        plain.n_red.clear();
        plain.n_blue.clear();
        const std::vector<std::vector<double>> alone = light_through(plain);
        double apart = 0.0, total = 0.0;
        for (std::size_t i = 0; i < alone[0].size(); ++i) {
            apart += std::abs(alone[std::size_t(c)][i] - together[std::size_t(c)][i]);
            total += alone[std::size_t(c)][i];
            parts += std::abs(alone[1][i] / 2.0 - together[0][i]);
        }
        EXPECT_LT(apart, 1e-3 * total) << c;
    }
    EXPECT_GT(parts, 10.0);
}

TEST_F(Wavefront, SpotLightsFillTheirCone) {
    Scene scene;
    place(scene, block(64, 2.0f, 1.0f, glm::vec3(0.0f)));
    add_plane(scene, {0.0f, -2.0f, 0.0f}, {3.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -3.0f});
    Light spot = point({0.0f, 3.0f, 0.0f}, glm::vec3(5.0f));
    spot.kind = Light::Kind::kSpot;
    spot.direction = {0.0f, -1.0f, 0.0f};
    spot.inner_cone_angle = 0.1f;
    spot.outer_cone_angle = 0.2f;
    scene.lights = {spot};
    trace(scene);
    // The square of a ramp in the cosine, between cosines i and o: 2 pi (1 - i) + 2 pi (i - o) / 3.
    const double i = std::cos(0.1), o = std::cos(0.2);
    const double power = 5.0 * 2.0 * std::numbers::pi * ((1.0 - i) + (i - o) / 3.0);
    EXPECT_NEAR(power_on_objects().x, power, 0.01 * power);
}

// A table that a volume's box dips into, as that of a glass on it does.
TEST_F(Wavefront, SurfacesInVolumesStopTheLight) {
    Scene scene;
    place(scene, block(32, 1.0f, 1.3f, glm::vec3(0.5f)));
    add_plane(scene, {0.0f, -0.25f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f})};
    trace(scene);
    const double expected = std::exp(-0.5 * 0.75);
    EXPECT_NEAR(power_on_objects().x, expected, 0.01 * expected);
    const std::vector<glm::vec4> light = voxel_light();
    EXPECT_GT(light[16 + 32 * (12 + 32 * 16)].x, 0.5f);
    EXPECT_EQ(light[16 + 32 * (4 + 32 * 16)].x, 0.0f);
}

/// A ball around `center`, of triangles whose edges are `1 / parts` of its radius or less.
void add_ball(Scene& scene, glm::vec3 center, float radius, unsigned parts) {
    if (scene.materials.empty()) scene.materials.emplace_back();
    Mesh mesh;
    const unsigned around = 6 * parts, rows = 3 * parts;
    for (unsigned row = 0; row <= rows; ++row)
        for (unsigned k = 0; k <= around; ++k) {
            const float theta = std::numbers::pi_v<float> * float(row) / float(rows),
                        phi = 2.0f * std::numbers::pi_v<float> * float(k) / float(around);
            const glm::vec3 normal(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            mesh.normals.push_back(normal);
            mesh.positions.push_back(center + radius * normal);
        }
    for (unsigned row = 0; row < rows; ++row)
        for (unsigned k = 0; k < around; ++k) {
            const unsigned a = row * (around + 1) + k, b = a + around + 1;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
    Object object;
    object.mesh = int(scene.meshes.size());
    scene.meshes.push_back(mesh);
    scene.objects.push_back(object);
}

// An opaque ball below a block that absorbs, and one in it: the power on them is what their cross-section gets, and the
// ground lacks it. A patch is as wide as 1/16 of the radius.
TEST_F(Wavefront, PowerOnBallsIsThatOfTheirCrossSection) {
    const glm::vec3 sigma(0.3f, 0.6f, 1.2f);
    for (const float height : {-1.2f, 0.0f}) {
        Scene scene;
        place(scene, block(64, 1.6f, 1.0f, sigma));
        const double bar = height == 0.0f ? 0.02 : 0.01, radius = 0.4, area = std::numbers::pi * radius * radius;
        add_ball(scene, {0.1f, height, -0.05f}, float(radius), 16);
        add_plane(scene, {0.0f, -2.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
        scene.lights = {directional({0.0f, -1.0f, 0.0f})};
        trace(scene);
        const glm::dvec3 on_ball = power_on_objects(0), on_ground = power_on_objects(1);
        for (int c = 0; c < 3; ++c) {
            // In the block: over the way through it to the ball's upper half, integrated in closed form.
            const double s = double(sigma[c]), through = std::exp(-1.6 * s);
            double expected = area * through;
            if (height == 0.0f) {
                // Integral of 2 pi r exp(-s (0.8 - sqrt(R^2 - r^2))) = 2 pi exp(-0.8 s) times that of u exp(s u), u from 0 to R.
                const double integral = (std::exp(s * radius) * (s * radius - 1.0) + 1.0) / (s * s);
                expected = 2.0 * std::numbers::pi * std::exp(-0.8 * s) * integral;
            }
            std::printf("ball at %.1f, colour %d: %.5f, expected %.5f\n", double(height), c, on_ball[c], expected);
            // In the volume a patch lands by its middle, so that some of what straddles the silhouette passes it.
            EXPECT_NEAR(on_ball[c], expected, bar * expected);
            EXPECT_NEAR(on_ground[c], (1.6 * 1.6 - area) * through, bar * (1.6 * 1.6 - area) * through);
        }
    }
}

struct Lookup {
    glm::vec4 position, way, medium;
};
struct Found {
    glm::vec4 scattered, received;
};

TEST_F(Wavefront, ShadersLookLightUp) {
    Scene scene;
    const glm::dvec3 sigma(0.02, 0.05, 0.1);
    place(scene, block(32, 1.0f, 1.0f, glm::vec3(sigma)),
          glm::rotate(glm::mat4(1.0f), 0.3f, glm::vec3(0.0f, 1.0f, 0.0f)));
    add_plane(scene, {0.0f, -1.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -2.0f});
    scene.lights = {directional({0.0f, -1.0f, 0.0f}, {3.0f, 2.0f, 1.0f})};
    trace(scene);
    const glm::vec3 way = glm::normalize(glm::vec3(0.3f, -0.5f, 0.2f));
    const float g = 0.4f;
    const std::vector<Lookup> cases = {
        {glm::vec4(0.1f, 0.2f, -0.1f, 1.0f), glm::vec4(way, 1.0f), glm::vec4(0.1f, 0.2f, 0.3f, g)},
        {glm::vec4(0.1f, -1.0f, -0.1f, 1.0f), glm::vec4(0.0f, 1.0f, 0.0f, 0.0f), glm::vec4(0.0f)},
        {glm::vec4(1.5f, -1.0f, -0.1f, 1.0f), glm::vec4(0.0f, 1.0f, 0.0f, 0.0f), glm::vec4(0.0f)},
        {glm::vec4(0.1f, -1.0f, -0.1f, 1.0f), glm::vec4(0.0f, -1.0f, 0.0f, 0.0f), glm::vec4(0.0f)}};
    const Buffer& input = workspace().buffer("cases", cases.size() * sizeof(Lookup), true);
    const Buffer& output = workspace().buffer("answers", cases.size() * sizeof(Found), true);
    std::memcpy(input.mapped(), cases.data(), input.size());
    const LightVolumes& light = tracer().light();
    recorder().compute(workspace().compute(shaders::light_lookup_twin_comp),
                       {reads("light_irradiance", light.irradiance), reads("light_direction", light.direction),
                        reads("Volumes", volumes().records), reads("Placements", light.placements),
                        all_of(tracer().photons()), reads("Cases", input), writes("Answers", output)},
                       {std::uint32_t(cases.size()), 1});
    recorder().submit_and_wait();
    const std::vector<Found> found = read_back<Found>(output);
    const double phase = henyey_greenstein(-double(way.y), double(g));
    const glm::dvec3 expected = glm::dvec3(0.1, 0.2, 0.3) * glm::dvec3(3.0, 2.0, 1.0) * phase;
    for (int c = 0; c < 3; ++c) {
        const double in_voxel = expected[c] * std::exp(-0.3 * sigma[c]);  // below the top of the volume
        EXPECT_NEAR(double(found[0].scattered[c]), in_voxel, 0.01 * in_voxel);
        const double missing = (3.0 - c) * (std::exp(-sigma[c]) - 1.0);  // on the ground, for what the volume absorbs
        EXPECT_NEAR(double(found[1].received[c]), missing, 0.02 * std::abs(missing));
        EXPECT_EQ(found[2].received[c], 0.0f);
        EXPECT_EQ(found[3].received[c], 0.0f);  // the other side
    }
}

}  // namespace
}  // namespace pellucid::test
