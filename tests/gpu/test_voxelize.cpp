// Meshes to volumes on the device, against solids whose volume and surface are known.
#include "gpu/device_test.h"
#include "unit/test_meshes.h"
#include "volume/voxelize.h"

#include <pellucid/error.h>

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>

#include <numbers>

namespace pellucid::test {
namespace {

using ::testing::HasSubstr;

class Voxelize : public DeviceTest {
protected:
    VoxelizedScene make(const Scene& scene, const VoxelSettings& settings = {}) {
        return voxelize(device(), scene, settings);
    }
    std::string error_of(const Scene& scene, const VoxelSettings& settings = {}) {
        try {
            make(scene, settings);
            return {};
        } catch (const Error& error) {
            return error.what();
        }
    }
};

/// Volume and centre of mass of what has more than the index 1, where all of it has `ior`.
struct Content {
    double volume = 0.0;
    glm::dvec3 center{0.0};
};

Content content_of(const Volume& v, double ior) {
    Content content;
    const double voxel = double(v.voxel);
    std::size_t i = 0;
    for (unsigned z = 0; z < v.size.z; ++z)
        for (unsigned y = 0; y < v.size.y; ++y)
            for (unsigned x = 0; x < v.size.x; ++x, ++i) {
                const double share = (double(v.n[i]) - 1.0) / (ior - 1.0) * voxel * voxel * voxel;
                content.volume += share;
                content.center += share * (glm::dvec3(v.low) + voxel * (glm::dvec3(x, y, z) + 0.5));
            }
    content.center /= content.volume;
    return content;
}

/// Adds a mesh of its own as glass.
void add_solid(Scene& scene, Mesh mesh, float ior) {
    Material glass;
    glass.transmission = glass.thickness = 1.0f;
    glass.ior = ior;
    mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
    Object object;
    object.name = mesh.name;
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(std::move(glass));
    scene.objects.push_back(std::move(object));
}

/// Six times the volume that a closed mesh encloses are triple products of its triangles.
double exact_volume(const Mesh& mesh) {
    double six = 0.0;
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        six += glm::dot(a, glm::cross(b, c));
    }
    return six / 6.0;
}

/// Where n crosses the middle between 1 and `ior` along +x through the voxel nearest to `start`.
double crossing_along_x(const Volume& v, glm::dvec3 start, double ior) {
    const glm::dvec3 at = (start - glm::dvec3(v.low)) / double(v.voxel) - 0.5;
    const auto y = std::size_t(std::lround(at.y)), z = std::size_t(std::lround(at.z));
    const double middle = 0.5 * (1.0 + ior);
    for (auto x = std::size_t(std::lround(at.x)); x + 1 < v.size.x; ++x) {
        const std::size_t i = x + v.size.x * (y + v.size.y * z);
        const double here = double(v.n[i]), next = double(v.n[i + 1]);
        if (here >= middle && next < middle)
            return double(v.low.x) + double(v.voxel) * (double(x) + 0.5 + (here - middle) / (here - next));
    }
    return 1e9;
}

TEST_F(Voxelize, ContentOfKnownSolids) {
    for (const bool smooth : {false, true}) {
        VoxelSettings settings;
        settings.resolution = 64;
        if (!smooth) settings.smoothing = 0.0f;
        for (const char* shape : {"shape:sphere,segments=96", "shape:torus", "shape:cube"}) {
            Scene scene = load_scene(shape);
            // Turned, mirrored, moved and not scaled alike: nothing falls onto the lattice.
            glm::mat4 world = glm::translate(glm::mat4(1.0f), {3.0f, -2.0f, 0.7f});
            world = glm::rotate(world, 0.7f, glm::normalize(glm::vec3(1.0f, 2.0f, -0.4f)));
            world = glm::scale(world, {1.3f, -0.8f, 1.1f});
            scene.objects[0].world_from_object = world;
            const Volume v = make(scene, settings).volume;
            const double expected =
                exact_volume(scene.meshes[0]) * std::abs(glm::determinant(glm::dmat3(glm::dmat4(world))));
            const Content found = content_of(v, 1.5);
            EXPECT_NEAR(found.volume / expected, 1.0, 1e-3) << shape << smooth;
            EXPECT_LT(glm::distance(found.center, glm::dvec3(3.0, -2.0, 0.7)), 0.02 * double(v.voxel)) << shape;
        }
    }
}

TEST_F(Voxelize, ACubeOnTheLatticeIsExact) {
    Scene scene;
    add_solid(scene, cube(2.0f), 1.7f);
    VoxelSettings settings;
    settings.resolution = 20;  // two at either side, 16 inside
    settings.smoothing = 0.0f;
    const Volume v = make(scene, settings).volume;
    EXPECT_EQ(v.size, glm::uvec3(20));
    std::size_t i = 0;
    for (unsigned z = 0; z < 20; ++z)
        for (unsigned y = 0; y < 20; ++y)
            for (unsigned x = 0; x < 20; ++x, ++i) {
                const bool inside = std::min({x, y, z}) >= 2 && std::max({x, y, z}) < 18;
                ASSERT_EQ(v.n[i], inside ? 1.7f : 1.0f) << x << " " << y << " " << z;
            }
}

TEST_F(Voxelize, SurfacesAreWhereTheyWere) {
    Scene scene = load_scene("shape:sphere,segments=256");
    const Volume v = make(scene, {.resolution = 64}).volume;
    EXPECT_NEAR(crossing_along_x(v, glm::dvec3(0.0), 1.5), 1.0, 0.05 * double(v.voxel));
    // And reflect there alone: the voxel with most of it is the one that the surface goes through.
    const glm::dvec3 middle = -glm::dvec3(v.low) / double(v.voxel);
    const std::size_t row = v.size.x * (std::size_t(middle.y) + v.size.y * std::size_t(middle.z));
    const auto first = v.boundary.begin() + std::ptrdiff_t(row + std::size_t(middle.x)),
               end = v.boundary.begin() + std::ptrdiff_t(row + v.size.x);
    const double most = middle.x + double(std::max_element(first, end) - first) + 0.5;
    EXPECT_NEAR(double(v.low.x) + double(v.voxel) * (std::floor(most) + 0.5), 1.0, 0.75 * double(v.voxel));
    EXPECT_GT(*std::max_element(first, end), 0.85f);
    EXPECT_EQ(*first, 0.0f) << "nothing reflects in the middle";
}

TEST_F(Voxelize, InnerObjectsDisplaceOuterOnes) {
    Scene scene;
    add_solid(scene, cube(1.0f), 1.2f);  // first, although it is the inner one
    add_solid(scene, cube(2.0f), 1.7f);
    for (Material& m : scene.materials) m.attenuation_distance = m.ior, m.attenuation_color = glm::vec3(0.5f);
    const Volume v = make(scene, {.resolution = 20, .smoothing = 0.0f}).volume;
    const auto at = [&](unsigned x) { return x + v.size.x * (10u + v.size.y * 10u); };
    EXPECT_EQ(v.n[at(10)], 1.2f);
    EXPECT_EQ(v.n[at(4)], 1.7f);
    EXPECT_EQ(v.n[at(0)], 1.0f);
    EXPECT_NEAR(v.sigma_a[at(10)].r, std::numbers::ln2 / 1.2, 1e-4);
    EXPECT_NEAR(v.sigma_a[at(4)].r, std::numbers::ln2 / 1.7, 1e-4);
    EXPECT_EQ(v.sigma_a[at(0)].r, 0.0f);
}

TEST_F(Voxelize, OpenMeshesAreNamed) {
    Scene scene;
    Mesh lid = cube(2.0f, glm::vec3(5.0f, 0.0f, 0.0f));
    lid.name = "pot";
    lid.triangles.resize(lid.triangles.size() - 3);  // one face across the columns and half of one along them
    add_solid(scene, cube(2.0f), 1.5f);
    add_solid(scene, lid, 1.5f);
    const VoxelizedScene made = make(scene, {.resolution = 32});
    ASSERT_EQ(made.warnings.size(), 1u);
    EXPECT_THAT(made.warnings[0], HasSubstr("object pot: its mesh is not closed"));
    for (const float n : made.volume.n) ASSERT_TRUE(n >= 1.0f && n <= 1.5f + 1e-5f) << n;
}

TEST_F(Voxelize, MediaAndNoise) {
    Scene scene = load_scene("shape:sphere");
    scene.materials[0].dispersion = 1.0f;
    VoxelSettings settings{.resolution = 24, .scattering = 3.0f, .g = 0.6f};
    const Volume plain = make(scene, settings).volume;
    settings.noise = 1.0f;
    const Volume noisy = make(scene, settings).volume;
    const std::size_t middle = 12 + 24 * (12 + 24 * 12);
    EXPECT_FLOAT_EQ(plain.sigma_s[middle].g, 3.0f);
    EXPECT_FLOAT_EQ(plain.g[middle], 0.6f);
    EXPECT_LT(plain.n_red[middle], plain.n[middle]);
    EXPECT_GT(plain.n_blue[middle], plain.n[middle]);
    EXPECT_TRUE(plain.sigma_a.empty());
    std::size_t other = 0;
    for (std::size_t i = 0; i < plain.voxel_count(); ++i) {
        other += noisy.sigma_s[i] != plain.sigma_s[i];
        ASSERT_GE(noisy.sigma_s[i].r, 0.0f);
        ASSERT_LE(noisy.sigma_s[i].r, 2.0f * plain.sigma_s[i].r + 1e-5f);
    }
    EXPECT_GT(other, 1000u);
}

TEST_F(Voxelize, WhatCannotBeMadeIsSaid) {
    const Scene ball = load_scene("shape:sphere");
    EXPECT_THAT(error_of(ball, {.resolution = 7}), HasSubstr("resolution must be 8 to 65536"));
    EXPECT_THAT(error_of(ball, {.resolution = 65537}), HasSubstr("resolution"));
    EXPECT_THAT(error_of(ball, {.resolution = 65536}), HasSubstr("voxels need"));
    EXPECT_THAT(error_of(ball, {.smoothing = 17.0f}), HasSubstr("smoothing must be 0 to 16"));
    EXPECT_THAT(error_of(ball, {.smoothing = std::nanf("")}), HasSubstr("smoothing"));
    EXPECT_THAT(error_of(ball, {.resolution = 32, .smoothing = 16.0f}), HasSubstr("take a higher resolution"));
    EXPECT_THAT(error_of(ball, {.samples = 0}), HasSubstr("samples must be 1 to 16"));
    EXPECT_THAT(error_of(ball, {.scattering = -1.0f}), HasSubstr("scattering"));
    EXPECT_THAT(error_of(ball, {.g = 1.0f}), HasSubstr("g must be"));
    EXPECT_THAT(error_of(ball, {.noise = 1.5f}), HasSubstr("noise must be"));
    EXPECT_THAT(error_of(ball, {.noise_scale = -1.0f}), HasSubstr("noise's scale"));
    EXPECT_THAT(error_of(load_scene("volume:smoke,resolution=8")), HasSubstr("no solids of glass"));
}

}  // namespace
}  // namespace pellucid::test
