// Volumes on the CPU: what makers make, smoothing, and what is refused.
#include "optics/index_fields.h"

#include <pellucid/error.h>
#include <pellucid/scene.h>

#include <gmock/gmock.h>

#include <cmath>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;

std::size_t index(const Volume& volume, unsigned x, unsigned y, unsigned z) {
    return x + std::size_t(volume.size.x) * (y + std::size_t(volume.size.y) * z);
}
glm::dvec3 center(const Volume& volume, unsigned x, unsigned y, unsigned z) {
    return glm::dvec3(volume.low) + double(volume.voxel) * (glm::dvec3(x, y, z) + 0.5);
}

void expect_refused(const std::string& spec, const std::vector<std::string>& words) {
    try {
        make_volume(spec);
        FAIL() << spec;
    } catch (const Error& error) {
        for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word)) << spec;
        EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
    }
}

TEST(Volumes, EveryMakerMakesOneWithItsDefaults) {
    for (const ShapeInfo& info : volume_infos()) {
        const Volume volume = make_volume(std::string(info.name) + ",resolution=16");
        EXPECT_EQ(std::max({volume.size.x, volume.size.y, volume.size.z}), 16u) << info.name;
        EXPECT_TRUE(!volume.n.empty() || !volume.sigma_s.empty()) << info.name;
        EXPECT_NO_THROW(check_volume(volume)) << info.name;
    }
}

TEST(Volumes, HoldTheirFields) {
    const Volume volume = make_volume("luneburg,resolution=32,radius=2");
    const LuneburgField<double> field{2.0};
    for (const unsigned z : {0u, 9u, 31u})
        for (const unsigned y : {3u, 16u})
            for (unsigned x = 0; x < 32; ++x)
                EXPECT_NEAR(double(volume.n[index(volume, x, y, z)]), field(center(volume, x, y, z)).n, 1e-6);
}

TEST(Volumes, SolidsAreSmoothedBalls) {
    const Volume ball = make_volume("smoothed-sphere,resolution=64,ior=1.6,red=2,dispersion=1");
    double inside = 0.0;
    for (std::size_t i = 0; i < ball.n.size(); ++i) inside += double((ball.n[i] - 1.0f) / 0.6f);
    const double cubic_metres = inside * std::pow(double(ball.voxel), 3);
    EXPECT_NEAR(cubic_metres, 4.0 / 3.0 * std::numbers::pi, 0.01);
    const std::size_t middle = index(ball, 32, 32, 32);
    EXPECT_FLOAT_EQ(ball.n[middle], 1.6f);
    EXPECT_LT(ball.n_red[middle], ball.n[middle]);
    EXPECT_GT(ball.n_blue[middle], ball.n[middle]);
    EXPECT_FLOAT_EQ(ball.sigma_a[middle].r, 2.0f);
    EXPECT_FLOAT_EQ(ball.boundary[middle], 0.0f);
    EXPECT_GT(*std::max_element(ball.boundary.begin(), ball.boundary.end()), 0.9f);
}

TEST(Volumes, LayersOfTheCubeAlternate) {
    const Volume cube = make_volume("rounded-cube,resolution=128,layers=4,other-ior=1.3");
    // From the middle of a face inwards: 0.8 / 4 m each.
    const auto at = [&](double depth) {
        const auto x = unsigned((0.8 - depth - double(cube.low.x)) / double(cube.voxel));
        return cube.n[index(cube, x, 64, 64)];
    };
    EXPECT_NEAR(at(0.1), 1.5f, 1e-3f);
    EXPECT_NEAR(at(0.3), 1.3f, 1e-3f);
    EXPECT_NEAR(at(0.5), 1.5f, 1e-3f);
    EXPECT_NEAR(at(0.7), 1.3f, 1e-3f);
}

TEST(Volumes, NoiseKeepsAbsorptionNearItsMean) {
    const Volume even = make_volume("smoothed-sphere,resolution=32,red=3");
    const Volume ragged = make_volume("smoothed-sphere,resolution=32,red=3,noise=1");
    double a = 0.0, b = 0.0, spread = 0.0;
    for (std::size_t i = 0; i < even.sigma_a.size(); ++i) {
        a += double(even.sigma_a[i].r);
        b += double(ragged.sigma_a[i].r);
        spread += std::abs(double(even.sigma_a[i].r) - double(ragged.sigma_a[i].r));
    }
    EXPECT_NEAR(b / a, 1.0, 0.15);
    EXPECT_GT(spread / a, 0.1);
}

TEST(Volumes, SmoothingIsAGaussian) {
    Volume volume;
    volume.name = "step";
    volume.size = glm::uvec3(40, 3, 4);
    for (unsigned i = 0; i < volume.voxel_count(); ++i) volume.n.push_back(i % 40 < 20 ? 1.0f : 2.0f);
    smooth_index(volume, 2.0f);
    for (unsigned x = 0; x < 40; ++x) {
        // The step lies between voxels 19 and 20; sums over voxels stand for the integral.
        const double exact = 1.0 + smoothed_inside(19.5 - double(x), 2.0);
        EXPECT_NEAR(double(volume.n[x + 40 * 2]), exact, 3e-3) << x;
    }
    EXPECT_THROW(smooth_index(volume, -1.0f), Error);
}

TEST(Volumes, AreRefusedWhereTheyCannotBe) {
    expect_refused("lunenburg", {"unknown volume 'lunenburg'", "luneburg, maxwell-fisheye"});
    expect_refused("luneburg,resolution=0", {"volume 'luneburg'", "resolution", "outside 4 to"});
    expect_refused("luneburg,resolution=20.5", {"whole number"});
    expect_refused("luneburg,resolution=60000", {"60000 x 60000 x 60000 voxels need", "GiB"});
    expect_refused("linear,slope=-3", {"volume 'linear'", "below 0.1"});
    expect_refused("smoke,colour=1", {"unknown parameter 'colour'", "scattering"});
    Volume volume = make_volume("linear,resolution=8");
    volume.n.pop_back();
    EXPECT_THROW(check_volume(volume), Error);
    volume = make_volume("linear,resolution=8");
    volume.n[100] = NAN;
    EXPECT_THROW(check_volume(volume), Error);
    volume = make_volume("smoke,resolution=8");
    volume.g[7] = 1.0f;
    EXPECT_THROW(check_volume(volume), Error);
}

TEST(Volumes, AreScenes) {
    const Scene scene = load_scene("volume:luneburg,resolution=8,radius=3");
    ASSERT_EQ(scene.volumes.size(), 1u);
    ASSERT_EQ(scene.volume_objects.size(), 1u);
    const Bounds bounds = scene_bounds(scene);
    EXPECT_NEAR(bounds.half_size.x, 3.1875f, 1e-4f);
    EXPECT_NEAR(bounds.radius, 3.1875f * std::sqrt(3.0f), 1e-3f);
}

}  // namespace
}  // namespace pellucid::test
