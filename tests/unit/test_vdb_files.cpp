// OpenVDB files: what is saved is loaded, other tools' grids by mapping, and what is refused.
#include "unit/test_files.h"

#include <pellucid/volume.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace pellucid::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// Every field, each with numbers of its own.
Volume full_volume() {
    Volume volume = make_volume("rounded-cube,resolution=24,dispersion=1,red=2,blue=1,scattering=3,g=0.4,noise=1");
    volume.low += glm::vec3(3.0f, -2.0f, 0.25f);
    volume.emission.resize(volume.voxel_count());
    for (std::size_t i = 0; i < volume.voxel_count(); ++i) volume.emission[i] = glm::vec3(0.0f, float(i % 7), 0.5f);
    volume.n[0] = 1.25f;  // a face of the box that is not as the background
    return volume;
}

void expect_same(const Volume& a, const Volume& b) {
    EXPECT_EQ(a.size, b.size);
    EXPECT_FLOAT_EQ(a.voxel, b.voxel);
    EXPECT_LT(glm::distance(a.low, b.low), 1e-5f * a.voxel + 1e-6f);
    EXPECT_EQ(a.n, b.n);
    EXPECT_EQ(a.n_red, b.n_red);
    EXPECT_EQ(a.n_blue, b.n_blue);
    EXPECT_EQ(a.sigma_a, b.sigma_a);
    EXPECT_EQ(a.sigma_s, b.sigma_s);
    EXPECT_EQ(a.g, b.g);
    EXPECT_EQ(a.emission, b.emission);
    EXPECT_EQ(a.boundary, b.boundary);
}

std::string volume_error(const std::filesystem::path& file, std::vector<GridMapping> mapping = {}) {
    try {
        load_volume(file, mapping);
        return {};
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(VdbFiles, HoldWhatWasSaved) {
    const TemporaryFolder folder;
    const Volume volume = full_volume();
    std::size_t bytes[2];
    for (const bool compress : {false, true})
        for (const bool double_precision : {false, true}) {
            const auto file = folder / "volume.vdb";
            save_volume(file, volume, {double_precision, compress});
            expect_same(volume, load_volume(file));
            bytes[compress] = std::filesystem::file_size(file);
        }
    EXPECT_LT(bytes[1], bytes[0]);
    EXPECT_EQ(folder.size(), 1u);  // and nothing temporary
}

TEST(VdbFiles, AreScenes) {
    const TemporaryFolder folder;
    save_volume(folder / "cloud.vdb", make_volume("smoke,resolution=12"));
    const Scene scene = load_scene((folder / "cloud.vdb").string());
    ASSERT_EQ(scene.volume_objects.size(), 1u);
    EXPECT_EQ(scene.volume_objects[0].name, "cloud");
    LoadOptions mapped;
    mapped.grids = {{"a", "n"}};
    EXPECT_THAT(load_error("shape:sphere", mapped), HasSubstr("has no grids"));
}

TEST(VdbFiles, GridsAreMapped) {
    const TemporaryFolder folder;
    const Volume smoke = make_volume("smoke,resolution=12");
    save_volume(folder / "smoke.vdb", smoke);
    const std::vector<GridMapping> mapping = {{"sigma_s", "sigma_a", 2.0f}, {"g", "boundary", 0.5f}};
    const Volume mapped = load_volume(folder / "smoke.vdb", mapping);
    EXPECT_TRUE(mapped.sigma_s.empty());
    ASSERT_EQ(mapped.sigma_a.size(), smoke.sigma_s.size());
    for (std::size_t i = 0; i < smoke.sigma_s.size(); ++i) {
        EXPECT_EQ(mapped.sigma_a[i], 2.0f * smoke.sigma_s[i]);
        EXPECT_EQ(mapped.boundary[i], 0.5f * smoke.g[i]);
    }
    const auto file = folder / "smoke.vdb";
    EXPECT_THAT(volume_error(file, {{"density", "n"}}), HasSubstr("there is no grid 'density'; it has 'sigma_s', 'g'"));
    EXPECT_THAT(volume_error(file, {{"g", "thickness"}}), HasSubstr("unknown field 'thickness'; known are n, n_red"));
    EXPECT_THAT(volume_error(file, {{"sigma_s", "n"}}), HasSubstr("grid 'sigma_s' has vectors, n wants numbers"));
    EXPECT_THAT(volume_error(file, {{"g", "n", -1.0f}}), HasSubstr("n at voxel (0, 0, 0) is not within 0.1..100"));
}

// Distances say where a volume reflects, beside an index of its own.
TEST(VdbFiles, DistancesAreSurfaces) {
    const TemporaryFolder folder;
    Volume saved = make_volume("luneburg,resolution=16");
    saved.g.resize(saved.voxel_count());
    for (std::size_t i = 0; i < saved.g.size(); ++i) saved.g[i] = 0.05f * (float(i % 16) - 7.5f) / 16.0f;  // m
    save_volume(folder / "lens.vdb", saved);
    const std::vector<GridMapping> mapping = {{"n", "n"}, {"g", "distance", 0.5f}};
    const Volume lens = load_volume(folder / "lens.vdb", mapping);
    EXPECT_EQ(lens.n, saved.n);
    EXPECT_TRUE(lens.g.empty());
    ASSERT_EQ(lens.boundary.size(), saved.voxel_count());
    const double sigma = 0.75 * double(saved.voxel);
    for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(double(lens.boundary[i]), std::exp(-0.5 * std::pow(0.5 * double(saved.g[i]) / sigma, 2.0)), 1e-6);
}

TEST(VdbFiles, DamagedOnesAreRefused) {
    const TemporaryFolder folder;
    save_volume(folder / "whole.vdb", make_volume("smoothed-sphere,resolution=32,red=1"));
    const std::string whole = content_of(folder / "whole.vdb");
    for (const std::size_t bytes :
         {std::size_t(0), std::size_t(7), std::size_t(100), whole.size() / 4, whole.size() / 2, whole.size() - 1}) {
        const std::string file = folder.file("cut.vdb", whole.substr(0, bytes));
        EXPECT_THAT(load_error(file), AllOf(HasSubstr("cut.vdb"), HasSubstr("OpenVDB"), Not(HasSubstr("\n")))) << bytes;
    }
    EXPECT_THAT(load_error(folder.file("noise.vdb", std::string(5000, 'x'))), HasSubstr("is no OpenVDB file"));
    EXPECT_THAT(load_error((folder / "none.vdb").string()), HasSubstr("no such file"));
    EXPECT_THAT(load_error(folder.path().string() + "/../" + folder.path().filename().string() + ".vdb"),
                HasSubstr("no such file"));
}

TEST(VdbFiles, HugeBoxesAreRefusedBeforeMemoryIsTaken) {
    const TemporaryFolder folder;
    save_volume(folder / "small.vdb", make_volume("luneburg,resolution=8"), {.compress = false});
    const std::string small = content_of(folder / "small.vdb");
    const auto claiming = [&](std::int32_t voxels) {
        std::string bytes = small;
        // After the entry's name and type in the metadata: bytes of the value (12), then three numbers.
        const std::size_t name = bytes.find("pellucid_voxels");
        const std::size_t size = bytes.find(std::string("\x0c\0\0\0\x08\0\0\0", 8), name);
        EXPECT_NE(size, std::string::npos);
        for (std::size_t k = 0; k < 3; ++k)
            bytes.replace(size + 4 + 4 * k, 4, reinterpret_cast<const char*>(&voxels), 4);
        return load_error(folder.file("huge.vdb", bytes));
    };
    EXPECT_THAT(claiming(60000), HasSubstr("60000 x 60000 x 60000 voxels need"));
    EXPECT_THAT(claiming(2000000000), HasSubstr("2000000000 voxels along x; 2 to 65536 are read"));
    EXPECT_THAT(claiming(1), HasSubstr("1 voxels along x"));
    EXPECT_THAT(claiming(0), HasSubstr("are empty"));
}

/// Files that other tools wrote.
TEST(VdbFiles, OfOtherTools) {
    const auto folder = data_folder() / "vdb";
    if (!std::filesystem::exists(folder / "smoke.vdb")) GTEST_SKIP() << "PELLUCID_TEST_DATA names no folder with vdb/";
    EXPECT_THAT(load_error((folder / "smoke.vdb").string()), HasSubstr("'density'"));
    const std::vector<GridMapping> density = {{"density", "sigma_s", 5.0f}};
    const Volume smoke = load_volume(folder / "smoke.vdb", density);
    EXPECT_EQ(smoke.size, glm::uvec3(130, 66, 66));
    EXPECT_FLOAT_EQ(std::max_element(smoke.sigma_s.begin(), smoke.sigma_s.end(),
                                     [](const auto& a, const auto& b) { return a.r < b.r; })
                        ->r,
                    5.0f);
    // A level set without a name: a ball, whose volume follows from the box of its narrow band.
    const std::vector<GridMapping> level_set = {{"", "level-set", 1.5f}};
    const Volume ball = load_volume(folder / "zeno_sphere.vdb", level_set);
    double inside = 0.0;
    for (const float n : ball.n) inside += double(n - 1.0f) / 0.5;
    const double radius = std::cbrt(inside * 0.75 / 3.14159265);  // voxels
    EXPECT_GT(radius, 5.0);
    EXPECT_NEAR(radius, 0.5 * double(ball.size.x) - 4.0, 1.5);  // three voxels of band and one more
    EXPECT_FLOAT_EQ(*std::max_element(ball.n.begin(), ball.n.end()), 1.5f);
}

}  // namespace
}  // namespace pellucid::test
