// ihrke-2007 in whole frames: volumes beside, around and before surfaces of glass and opaque things.
#include "gpu/exact_sphere.h"
#include "gpu/gpu_test.h"
#include "optics/index_fields.h"
#include "unit/built_scenes.h"
#include "unit/built_volumes.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <memory>
#include <tuple>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 96;

Mesh shape(const std::string& spec) { return load_scene("shape:" + spec).meshes.front(); }

glm::mat4 at(glm::vec3 position, float scale = 1.0f) {
    return glm::scale(glm::translate(glm::mat4(1.0f), position), glm::vec3(scale));
}

void place(Scene& scene, Volume volume, const glm::mat4& world_from_volume = glm::mat4(1.0f)) {
    scene.volume_objects.push_back({volume.name, int(scene.volumes.size()), world_from_volume, {}});
    scene.volumes.push_back(std::make_shared<const Volume>(std::move(volume)));
}

Material painted(glm::vec3 color) {
    Material material;
    material.base_color = glm::vec4(color, 1.0f);
    material.unlit = true;
    material.double_sided = true;
    return material;
}

/// Glass, and opaque things of several colours around it.
Scene glass_among_things() {
    Scene scene;
    add(scene, shape("sphere,segments=64"), glass());
    add(scene, shape("torus"), glass(1.4f), at({0.9f, 0.5f, -1.2f}, 0.6f));
    add(scene, shape("cube"), painted({0.1f, 0.8f, 0.2f}), at({-0.2f, 0.1f, 0.0f}, 0.2f));
    add(scene, square(), painted({0.9f, 0.3f, 0.1f}), at({-0.5f, 0, -2.5f}, 1.5f));
    return scene;
}

class Ihrke : public RendererTest {
protected:
    void set(const Scene& scene, const Environment& environment = uniform_environment()) {
        camera_ =
            framing_camera(Bounds{.center = {}, .radius = 1.0f, .half_size = {}}, kSize, kSize, Camera{}.vertical_fov);
        renderer().set_scene(scene);
        renderer().set_environment(environment);
        renderer().set_camera(camera_);
    }
    RenderResult draw(const char* technique = "ihrke-2007", ParameterMap parameters = {}) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.parameters = std::move(parameters);
        settings.paths = true;
        return renderer().render(settings);
    }
    Camera camera_;
};

/// Largest difference of two pictures, in all channels.
float largest_difference(const Image& a, const Image& b) {
    float most = 0.0f;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) most = std::max(most, std::abs(a.pixels[i] - b.pixels[i]));
    return most;
}
/// Share of the pixels that differ by more than `least` in some channel.
double share_that_differs(const Image& a, const Image& b, float least) {
    int differing = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const glm::vec3 d = glm::abs(rgb(a, x, y) - rgb(b, x, y));
            differing += std::max({d.r, d.g, d.b}) > least ? 1 : 0;
        }
    return double(differing) / (double(a.width) * a.height);
}

// Without volumes the technique is visibility-cube, from the eye on instead of from the first layer.
TEST_F(Ihrke, WithoutVolumesSurfacesAreThoseOfVisibilityCube) {
    set(glass_among_things(), Environment{});
    const RenderResult without = draw("visibility-cube", {{"branches", 4}}),
                       with = draw("ihrke-2007", {{"voxelize", 0}});
    int differ = 0, glass_pixels = 0;
    for (std::size_t i = 0; i < with.paths.size(); ++i) {
        if (without.paths[i].events == 0) continue;
        ++glass_pixels;
        differ += angle_deg(without.paths[i].direction, with.paths[i].direction) > 0.1 ? 1 : 0;
    }
    EXPECT_GT(glass_pixels, 1500);
    EXPECT_LE(differ, glass_pixels / 200);  // chaos: other last digits at the first surface
    EXPECT_LE(share_that_differs(without.radiance, with.radiance, 0.01f), 0.02);
}

// A volume of vacuum changes nothing, wherever it lies: around all, in part of it, before it or in its own smaller box.
TEST_F(Ihrke, VacuumIsInvisible) {
    const Scene bare = glass_among_things();
    set(bare, Environment{});
    const RenderResult expected = draw("ihrke-2007", {{"voxelize", 0}});
    struct Place {
        const char* name;
        glm::vec3 position;
        float half;
    };
    for (const Place& where : {Place{"around all", {0, 0, 0}, 4.0f}, Place{"in part", {0.4f, 0.4f, 0}, 0.9f},
                               Place{"before", {0, 0.3f, 1.6f}, 0.5f}, Place{"behind", {0, 0, -1.8f}, 0.5f}}) {
        Scene scene = bare;
        place(scene, even_cube(where.half), at(where.position));
        place(scene, even_cube(0.4f), at(where.position + glm::vec3(0.2f, 0, 0)));  // boxes overlap
        set(scene, Environment{});
        const RenderResult found = draw();
        // A path that starts again at a box has other last digits: what is beside edges and in chaos differs.
        EXPECT_LE(share_that_differs(expected.radiance, found.radiance, 0.01f), 0.01) << where.name;
        int lost = 0;
        for (const RefractedPath& path : found.paths) lost += path.status != Status::kOk ? 1 : 0;
        EXPECT_EQ(lost, 0) << where.name;
    }
}

// Beer and Lambert: a cube of even absorption before a white wall, seen through it and beside it. 1e-3: absorption is
// stored in 16 bits, of which 11 count.
TEST_F(Ihrke, AbsorptionFollowsBeerAndLambert) {
    Scene scene;
    const glm::vec3 sigma(0.3f, 0.9f, 2.0f);
    Volume volume = even_cube(0.5f);
    volume.sigma_a.assign(volume.voxel_count(), sigma);
    volume.sigma_s.assign(volume.voxel_count(), glm::vec3(0.25f));  // what is scattered away is lost to the ray, too
    place(scene, std::move(volume), at({0, 0, 0}, 1.4f));
    add(scene, square(), painted({1, 1, 1}), at({0, 0, -2.0f}, 40.0f));
    set(scene);
    const RenderResult found = draw();
    int through = 0;
    for (int y = 0; y < int(kSize); ++y)
        for (int x = 0; x < int(kSize); ++x) {
            const RefractedPath& path = found.paths[std::size_t(y) * kSize + std::size_t(x)];
            const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
            double near = 0.0, far = 1e30;
            for (int k = 0; k < 3; ++k) {
                const double a = (-0.7 - ray.origin[k]) / ray.direction[k],
                             b = (0.7 - ray.origin[k]) / ray.direction[k];
                near = std::max(near, std::min(a, b)), far = std::min(far, std::max(a, b));
            }
            const double length = std::max(far - near, 0.0);
            through += length > 0.1 ? 1 : 0;
            const glm::vec3 expected =
                glm::exp(-(sigma + 0.25f) * float(length) / 1.4f);  // a placement scales what is met, too
            EXPECT_LT(glm::distance(rgb(found.radiance, x, y), expected), 3e-3f) << x << ", " << y;
            if (length > 0.1) {
                EXPECT_NEAR(path.length_inside, length, 1e-3);
            }
        }
    EXPECT_GT(through, 1000);
}

// Emission without absorption: radiance is emission times the way through.
TEST_F(Ihrke, EmissionAddsUpAlongTheRay) {
    Scene scene;
    Volume volume = even_cube(0.5f);
    volume.emission.assign(volume.voxel_count(), glm::vec3(0.5f, 1.0f, 2.0f));
    place(scene, std::move(volume));
    set(scene, uniform_environment(glm::vec3(0.25f)));
    const RenderResult found = draw();
    int through = 0;
    for (std::size_t i = 0; i < found.paths.size(); ++i) {
        if (found.paths[i].events == 0) continue;
        ++through;
        const glm::vec3 expected = 0.25f + found.paths[i].length_inside * glm::vec3(0.5f, 1.0f, 2.0f);
        EXPECT_LT(glm::distance(rgb(found.radiance, int(i % kSize), int(i / kSize)), expected), 5e-3f);
    }
    EXPECT_GT(through, 500);
}

// A smoothed ball refracts as one of glass does: most rays to a degree, and all that nothing absorbs comes out.
TEST_F(Ihrke, SmoothedBallRefractsAsGlass) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=96,smoothing=0.75"));
    set(scene);
    const RenderResult found = draw();
    int inside = 0, right = 0;
    for (int y = 0; y < int(kSize); ++y)
        for (int x = 0; x < int(kSize); ++x) {
            const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
            const double miss = glm::length(glm::cross(ray.origin, ray.direction));
            if (miss > 0.9) continue;  // where the surface grazes its smoothing shows
            const auto exact = through_unit_sphere(ray, 1.5);
            const RefractedPath& path = found.paths[std::size_t(y) * kSize + std::size_t(x)];
            ++inside;
            right += angle_deg(path.direction, exact->direction) < 1.0 ? 1 : 0;
            EXPECT_EQ(path.events, 2) << x << ", " << y;
            // Fresnel, twice; by up to 1% wrong because the normal is the voxels'. Towards the rim errors grow.
            const double cos_theta = std::sqrt(1.0 - miss * miss);
            const double passes = 1.0 - fresnel_dielectric(cos_theta, 1.0 / 1.5);
            if (miss < 0.8) {
                EXPECT_NEAR(double(path.transmittance.g), passes * passes, 0.01) << x << ", " << y;
            }
            EXPECT_GT(path.length_inside, exact->length) << x << ", " << y;  // the box is wider than the ball
        }
    EXPECT_GT(inside, 1500);
    EXPECT_GT(double(right) / inside, 0.8);
    RecordProperty("within 1 degree", fmt::format("{:.4f}", double(right) / inside));
}

// The mesh that a volume stands for says where rays enter it: sharper than its voxels.
TEST_F(Ihrke, RaysEnterSharperAtTheMesh) {
    Scene scene;
    add(scene, shape("sphere,segments=256"), glass());
    place(scene, make_volume("smoothed-sphere,resolution=64,smoothing=0.75"));
    scene.volume_objects.back().objects = {0};
    set(scene);
    double mean[2] = {}, covered[2] = {};
    for (const int proxy : {0, 1}) {
        const RenderResult found = draw("ihrke-2007", {{"proxy", double(proxy)}});
        for (int y = 0; y < int(kSize); ++y)
            for (int x = 0; x < int(kSize); ++x) {
                const auto exact = through_unit_sphere(pixel_ray(camera_, kSize, kSize, x, y), 1.5);
                if (!exact) continue;
                const RefractedPath& path = found.paths[std::size_t(y) * kSize + std::size_t(x)];
                ++covered[proxy];
                mean[proxy] += angle_deg(path.direction, exact->direction);
                EXPECT_EQ(path.status, Status::kOk);
            }
        mean[proxy] /= covered[proxy];
    }
    EXPECT_GT(covered[0], 1500);
    EXPECT_LT(mean[1], 0.75 * mean[0]);  // the way out is as smooth as before
    RecordProperty("mean error, degrees", fmt::format("{:.3f} without, {:.3f} with the mesh", mean[0], mean[1]));
}

/// Distances of the lines in which paths go on from a point, voxels: root of the mean square, and largest.
struct Misses {
    double rms = 0.0, largest = 0.0;
    int count = 0;
};
template <class Counts>
Misses misses(const std::vector<RefractedPath>& paths, const glm::dvec3& point, double voxel, const Counts& counts) {
    Misses found;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const glm::dvec2 pixel(double(i % kSize) + 0.5, double(i / kSize) + 0.5);
        if (!counts(pixel / double(kSize) * 2.0 - 1.0)) continue;
        const double miss =
            glm::length(glm::cross(point - glm::dvec3(paths[i].position), glm::dvec3(paths[i].direction)));
        found.rms += miss * miss / (voxel * voxel);
        found.largest = std::max(found.largest, miss / voxel);
        ++found.count;
    }
    found.rms = std::sqrt(found.rms / std::max(found.count, 1));
    return found;
}

// Luneburg's lens, a radius of 60 voxels: parallel rays meet at the antipode, up to 0.9 of the radius.
TEST_F(Ihrke, LuneburgFocusesParallelRays) {
    Scene scene;
    place(scene, make_volume("luneburg,resolution=120"));
    set(scene);
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = 2.0f;
    camera.world_from_view[3] = glm::vec4(0, 0, 3, 1);
    renderer().set_camera(camera);
    const Misses found =
        misses(draw().paths, {0, 0, -1}, 2.0 / 120.0, [](const glm::dvec2& film) { return glm::length(film) < 0.9; });
    EXPECT_GT(found.count, 5000);
    EXPECT_LE(found.rms, 0.2);
    EXPECT_LE(found.largest, 0.5);
    fmt::print("Luneburg: rms {:.3f}, largest {:.3f} voxels\n", found.rms, found.largest);
}

// Maxwell's fish-eye images a point of its surface at its antipode: a cone of 80 degrees.
TEST_F(Ihrke, FisheyeImagesAtTheAntipode) {
    Scene scene;
    place(scene, make_volume("maxwell-fisheye,resolution=120"));
    set(scene);
    Camera camera;
    camera.vertical_fov = glm::radians(80.0f);
    camera.world_from_view[3] = glm::vec4(0, 0, 1, 1);
    renderer().set_camera(camera);
    const Misses found =
        misses(draw().paths, {0, 0, -1}, 2.0 / 120.0, [](const glm::dvec2& film) { return glm::length(film) < 1.0; });
    EXPECT_GT(found.count, 5000);
    EXPECT_LE(found.largest, 1.0);
    fmt::print("fish-eye: rms {:.3f}, largest {:.3f} voxels\n", found.rms, found.largest);
}

// Sharp interfaces: light crosses the mesh by Snell's law, with the index that the volume has there, and bends inside.
TEST_F(Ihrke, SharpInterfacesHoldVolumes) {
    for (const auto& [name, middle, fall] :
         {std::tuple{"even", 1.5f, 0.0f}, std::tuple{"graded", 1.8f, 0.3f}, std::tuple{"hollowed", 1.2f, -0.5f}}) {
        Scene scene;
        add(scene, shape("sphere,segments=128"), glass(1.5f));
        add(scene, shape("cube"), painted({0.1f, 0.8f, 0.2f}), at({0.3f, -0.2f, 0.1f}, 0.15f));
        place(scene, graded_ball(middle, fall));
        scene.volume_objects.back().objects = {0};
        set(scene);
        const auto exact = [&](glm::dvec2 shift) {
            return renderer().tracer().exact(camera_, {.width = kSize, .height = kSize, .shift_px = shift});
        };
        const std::vector<RefractedPath> truth = exact({0, 0}), right = exact({0.1, 0}), down = exact({0, 0.1});
        const RenderResult found = draw("ihrke-2007", {{"interfaces", 1}});
        int stable = 0, same = 0;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const auto near = [&](const RefractedPath& path) {
                return path.object == truth[i].object && angle_deg(path.direction, truth[i].direction) < 1.0;
            };
            if (truth[i].events == 0 || !near(right[i]) || !near(down[i])) continue;
            ++stable;
            same += near(found.paths[i]) ? 1 : 0;
        }
        EXPECT_GT(stable, 2000) << name;
        EXPECT_GE(same, 0.995 * stable) << name;  // what float cannot tell from another path
        RecordProperty(name, fmt::format("{} of {} stable pixels", same, stable));
        // Nothing absorbs, so the ball is invisible; the cube is not lit and shows its colour.
        const Image image = draw("ihrke-2007", {{"interfaces", 1}, {"branches", 4}}).radiance;
        for (std::size_t i = 0; i < truth.size(); ++i) {
            if (truth[i].object < 0 && found.paths[i].object < 0) {
                EXPECT_LT(image.pixels[3 * i], 1.001f) << name;
            }
        }
    }
}

// Nothing absorbs: where light is the same from everywhere, a volume with surfaces is invisible.
TEST_F(Ihrke, WhiteFurnace) {
    Scene scene;
    place(scene, make_volume("smoothed-sphere,resolution=48"));
    place(scene, make_volume("rounded-cube,resolution=48"), at({0.9f, -0.4f, -1.5f}));
    add(scene, shape("torus"), glass(), at({-0.6f, 0.3f, 0.9f}, 0.5f));
    set(scene);
    for (const double branches : {0.0, 4.0, 16.0}) {
        const Image image = draw("ihrke-2007", {{"branches", branches}}).radiance;
        const auto [least, most] = std::minmax_element(image.pixels.begin(), image.pixels.end());
        EXPECT_NEAR(*least, 1.0f, 1e-3f) << branches;
        EXPECT_NEAR(*most, 1.0f, 1e-3f) << branches;
    }
}

// Before a white wall, in the dark. What is transmitted at once is (1 - R)^2; with all that is reflected inside it adds up to
// (1 - R) / (1 + R), which at normal incidence is 2 n / (n^2 + 1).
TEST_F(Ihrke, SlabsReflectAsFresnelSaysWhateverTheStep) {
    for (const float n : {1.5f, 2.42f})
        for (const double smoothing : {0.5, 0.75, 1.0})
            for (const double step : {0.25, 0.5, 1.0}) {
                Scene scene;
                place(scene, slab(n, smoothing, 48));
                add(scene, square(), painted({1, 1, 1}), at({0, 0, -1.0f}, 3.0f));
                set(scene, uniform_environment(glm::vec3(0.0f)));
                const RenderResult found = draw("ihrke-2007", {{"step", step}, {"branches", 16}, {"threshold", 1e-4}});
                double path_error = 0.0, picture_error = 0.0;
                int seen = 0;
                for (int y = 40; y < 56; ++y)
                    for (int x = 40; x < 56; ++x) {
                        const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
                        const double c = -ray.direction.z, eta = 1.0 / double(n);
                        const double c_t = std::sqrt(1.0 - eta * eta * (1.0 - c * c));
                        const double rs = (c - double(n) * c_t) / (c + double(n) * c_t),
                                     rp = (c_t - double(n) * c) / (c_t + double(n) * c);
                        const double r = 0.5 * (rs * rs + rp * rp);
                        const RefractedPath& path = found.paths[std::size_t(y) * kSize + std::size_t(x)];
                        path_error += double(path.transmittance.g) / ((1.0 - r) * (1.0 - r)) - 1.0;
                        picture_error += double(rgb(found.radiance, x, y).g) * (1.0 + r) / (1.0 - r) - 1.0;
                        ++seen;
                    }
                std::printf("slab of %.2f, smoothing %.2f, step %.2f: path %+.4f, picture %+.4f\n", double(n),
                            smoothing, step, path_error / seen, picture_error / seen);
                EXPECT_NEAR(path_error / seen, 0.0, 0.005);
                EXPECT_NEAR(picture_error / seen, 0.0, 0.005);
            }
}

// A dispersive volume shows in each channel what one of that colour's index shows.
TEST_F(Ihrke, ColorsPartInDispersiveVolumes) {
    const Volume dispersive = make_volume("smoothed-sphere,resolution=48,dispersion=4");
    ASSERT_FALSE(dispersive.n_red.empty());
    Environment environment;
    environment.kind = Environment::Kind::kChecker;
    Scene scene;
    place(scene, dispersive);
    set(scene, environment);
    const Image together = draw("ihrke-2007", {{"branches", 0}}).radiance;
    const std::vector<float>* indices[] = {&dispersive.n_red, &dispersive.n, &dispersive.n_blue};
    for (int c = 0; c < 3; ++c) {
        Volume plain = dispersive;
        plain.n = *indices[c];
        plain.n_red.clear();
        plain.n_blue.clear();
        Scene alone;
        place(alone, std::move(plain));
        set(alone, environment);
        const Image expected = draw("ihrke-2007", {{"branches", 0}}).radiance;
        int differ = 0;
        for (std::size_t i = std::size_t(c); i < expected.pixels.size(); i += 3)
            differ += std::abs(expected.pixels[i] - together.pixels[i]) > 1e-4f ? 1 : 0;
        EXPECT_LE(differ, 5) << "channel " << c;  // red and blue start again at the box, with other last digits
    }
    EXPECT_GT(largest_difference(together,
                                 [&] {
                                     Scene green = scene;
                                     Volume plain = dispersive;
                                     plain.n_red.clear();
                                     plain.n_blue.clear();
                                     green.volumes[0] = std::make_shared<const Volume>(std::move(plain));
                                     set(green, environment);
                                     return draw("ihrke-2007", {{"branches", 0}}).radiance;
                                 }()),
              0.1f);
}

// A prism of 40 degrees deviates every colour by its own index, in every pixel that is four voxels from its edges.
TEST_F(Ihrke, PrismsDeviateEveryColor) {
    const glm::dvec3 enters(std::sin(glm::radians(20.0)), 0.0, std::cos(glm::radians(20.0))),
        leaves(enters.x, 0.0, -enters.z);
    const double off = 0.4 * enters.x;  // of both faces from the origin; their edge is at x = 0.4
    for (const float n : {1.5f, 1.52f, 1.55f}) {
        Volume prism = even_cube(0.5f, 64);
        const double voxel = double(prism.voxel);
        for (unsigned z = 0; z < 64; ++z)
            for (unsigned y = 0; y < 64; ++y)
                for (unsigned x = 0; x < 64; ++x) {
                    const glm::dvec3 at = (glm::dvec3(x, y, z) + 0.5) * voxel - 0.5;
                    const double distance = std::max(
                        {glm::dot(at, enters) - off, glm::dot(at, leaves) - off, -0.4 - at.x, std::abs(at.y) - 0.4});
                    prism.n.push_back(1.0f + (n - 1.0f) * float(smoothed_inside(distance, 0.75 * voxel)));
                }
        Scene scene;
        place(scene, prism);
        set(scene);
        const RenderResult found = draw();
        double squares = 0.0, worst = 0.0;
        int seen = 0;
        for (int y = 0; y < int(kSize); ++y)
            for (int x = 0; x < int(kSize); ++x) {
                const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
                const auto meet = [&](const glm::dvec3& from, const glm::dvec3& d, const glm::dvec3& normal) {
                    return from + (off - glm::dot(from, normal)) / glm::dot(d, normal) * d;
                };
                const auto clear = [&](const glm::dvec3& at) {
                    return at.x > -0.4 + 4.0 * voxel && at.x < 0.4 - 8.0 * voxel && std::abs(at.y) < 0.4 - 4.0 * voxel;
                };
                const glm::dvec3 in = meet(ray.origin, ray.direction, enters);
                const glm::dvec3 inside = glm::refract(ray.direction, enters, 1.0 / double(n));
                const glm::dvec3 out = meet(in, inside, leaves), expected = glm::refract(inside, -leaves, double(n));
                if (!clear(in) || !clear(out) || glm::length(expected) < 0.5) continue;
                const glm::dvec3 own(found.paths[std::size_t(y) * kSize + std::size_t(x)].direction);
                const double angle = glm::degrees(std::acos(std::min(glm::dot(own, expected), 1.0)));
                squares += angle * angle;
                worst = std::max(worst, angle);
                ++seen;
            }
        std::printf("prism of %.2f: rms %.4f, worst %.4f degrees, %d pixels\n", double(n), std::sqrt(squares / seen),
                    worst, seen);
        EXPECT_GT(seen, 300);
        EXPECT_LT(worst, 0.2);
    }
}

// An opaque thing is seen through a lens as it bends light: the wall behind Luneburg's lens is met where its exact ray
// goes on to.
TEST_F(Ihrke, OpaqueThingsAreSeenThroughBentRays) {
    Scene scene;
    place(scene, make_volume("luneburg,resolution=96"));
    set(scene);
    const RenderResult alone = draw();
    add(scene, square(), painted({1, 0, 0}), at({0, 0, -1.5f}, 30.0f));
    set(scene);
    const RenderResult before_wall = draw();
    int bent = 0;
    for (std::size_t i = 0; i < alone.paths.size(); ++i) {
        const RefractedPath &free = alone.paths[i], &stopped = before_wall.paths[i];
        if (free.events == 0 || free.direction.z > -0.3f) continue;
        const float t = (-1.5f - free.position.z) / free.direction.z;
        if (t < 0.0f) continue;
        ++bent;
        EXPECT_EQ(stopped.object, 0);
        EXPECT_LT(glm::distance(stopped.position, free.position + t * free.direction), 5e-3f * (1.0f + t));
        EXPECT_LT(glm::distance(rgb(before_wall.radiance, int(i % kSize), int(i / kSize)), glm::vec3(1, 0, 0)), 1e-3f);
    }
    EXPECT_GT(bent, 1500);
}

// A path that runs out of steps says so.
TEST_F(Ihrke, StepLimitIsAStatus) {
    Scene scene;
    place(scene, make_volume("luneburg,resolution=32"));
    set(scene);
    int limited = 0, done = 0;
    for (const RefractedPath& path : draw("ihrke-2007", {{"max-steps", 10}}).paths) {
        limited += path.status == Status::kStepLimit ? 1 : 0;
        done += path.events > 0 && path.status == Status::kOk ? 1 : 0;
    }
    EXPECT_GT(limited, 500);
    EXPECT_LT(done, limited);
}

/// Sunlight of 2 W/m2 that goes down, aslant.
Light sun() {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(glm::vec3(0.3f, -1.0f, -0.2f));
    light.intensity = glm::vec3(2.0f);
    return light;
}

Material white_ground() {
    Material material;
    material.base_color = glm::vec4(0.8f, 0.8f, 0.8f, 1.0f);
    material.roughness = 1.0f;
    material.metallic = 0.0f;
    material.double_sided = true;
    return material;
}

glm::mat4 flat_at(float y) {
    return glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), {0, y, 0}), -1.5707963f, {1, 0, 0}), glm::vec3(4.0f));
}

// In the dark all light is the sun's: on the ground past a volume of vacuum and, through it, behind it, and none shows
// where one goes over into the other. The coat of a dielectric of index 1.5 keeps 4%. 2e-3: power is counted in fixed
// point, and patches are flat.
TEST_F(Ihrke, SunShinesOnTheGroundThroughVolumesAndPastThem) {
    Scene scene;
    add(scene, square(), white_ground(), flat_at(-0.8f));
    place(scene, even_cube(0.5f, 24), at({0, 0, 0}));
    scene.lights.push_back(sun());
    set(scene, uniform_environment(glm::vec3(0.0f)));
    const RenderResult found = draw();
    const float cosine = 1.0f / std::sqrt(1.13f);
    int lit = 0;
    for (int y = 0; y < int(kSize); ++y)
        for (int x = 0; x < int(kSize); ++x) {
            const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
            if (ray.direction.y > -1e-3) continue;
            const glm::dvec3 p = ray.origin + ((-0.8 - ray.origin.y) / ray.direction.y) * ray.direction;
            if (std::max(std::abs(p.x), std::abs(p.z)) > 3.9) continue;
            ++lit;
            // The coat, of index 1.5, lets so much of the diffuse layer's light out to the viewer (Schlick).
            const float passes = 0.96f * (1.0f - std::pow(1.0f + float(ray.direction.y), 5.0f));
            const float expected = passes * 0.8f / 3.14159265f * 2.0f * cosine;
            EXPECT_NEAR(rgb(found.radiance, x, y).g, expected, 2e-3f * expected) << x << ", " << y;
        }
    EXPECT_GT(lit, 1500);
}

/// The part of a ray in a cube of half edge `half`, or in a ball of that radius, around the origin; empty: near > far.
std::pair<double, double> part_inside(bool ball, double half, const glm::dvec3& x, const glm::dvec3& d) {
    if (ball) {
        const double b = glm::dot(x, d), root = b * b - glm::dot(x, x) + half * half;
        return root > 0.0 ? std::pair(-b - std::sqrt(root), -b + std::sqrt(root)) : std::pair(1.0, 0.0);
    }
    const glm::dvec3 s = (-half - x) / d, t = (half - x) / d, low = glm::min(s, t), high = glm::max(s, t);
    return {std::max({low.x, low.y, low.z}), std::min({high.x, high.y, high.z})};
}

// Light that is scattered once in an even medium: sigma_s times the phase function times the irradiance, less what is
// lost on the way in and out, along the way through. The bar of 2% holds for the mean; a pixel has the scatter of few
// voxels where it looks through a corner (10%).
TEST_F(Ihrke, EvenSmokeScattersLightOnce) {
    const double sigma_s = 0.8, sigma_a = 0.5, irradiance = 2.0;
    for (const bool ball : {false, true})
        for (const float g : {0.0f, 0.6f}) {
            Scene scene;
            const double half = ball ? 0.45 : 0.5;
            Volume smoke = even_cube(0.5f, 48);
            for (unsigned z = 0; z < 48; ++z)
                for (unsigned y = 0; y < 48; ++y)
                    for (unsigned x = 0; x < 48; ++x) {
                        const double r = glm::length((glm::dvec3(x, y, z) + 0.5) / 48.0 - 0.5);
                        const auto share = float(ball ? smoothed_inside(r - half, 0.3 / 48.0) : 1.0);
                        smoke.sigma_s.emplace_back(share * float(sigma_s));
                        smoke.sigma_a.emplace_back(share * float(sigma_a));
                    }
            smoke.g.assign(smoke.voxel_count(), g);
            place(scene, std::move(smoke));
            scene.lights.push_back(sun());
            set(scene, uniform_environment(glm::vec3(0.0f)));
            const RenderResult found = draw();
            int seen = 0;
            double found_sum = 0.0, expected_sum = 0.0, worst = 0.0;
            for (int y = 0; y < int(kSize); ++y)
                for (int x = 0; x < int(kSize); ++x) {
                    const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
                    const auto [near, far] = part_inside(ball, half, ray.origin, ray.direction);
                    if (far - near < 0.3) continue;
                    ++seen;
                    const glm::dvec3 way(sun().direction);
                    const double base = 1.0 + double(g * g) + 2.0 * double(g) * glm::dot(ray.direction, way);
                    const double phase = (1.0 - double(g * g)) / (12.566370614 * base * std::sqrt(base));
                    constexpr int kSteps = 100;
                    double expected = 0.0;
                    for (int k = 0; k < kSteps; ++k) {
                        const double out = (k + 0.5) / kSteps * (far - near);
                        const auto lit = part_inside(ball, half, ray.origin + (near + out) * ray.direction, -way);
                        expected += sigma_s * phase * irradiance * std::exp(-(sigma_s + sigma_a) * (out + lit.second)) *
                                    (far - near) / kSteps;
                    }
                    const double own = double(rgb(found.radiance, x, y).g);
                    found_sum += own;
                    expected_sum += expected;
                    worst = std::max(worst, std::abs(own / expected - 1.0));
                }
            std::printf("scattered once in a %s, g %.1f: mean %.4f, worst %.4f, %d pixels\n", ball ? "ball" : "cube",
                        double(g), found_sum / expected_sum, worst, seen);
            EXPECT_GT(seen, 300);
            EXPECT_NEAR(found_sum / expected_sum, 1.0, 0.02);
            EXPECT_LT(worst, 0.1);
        }
}

// Every frame shows the light of one moment, which is 3 to 6 frames ago, as if it had been traced at once; and what changes
// from frame to frame is what the light itself changes, within 1/255 of the display in the mean.
TEST_F(Ihrke, MovingLightsAreTracedInSlices) {
    constexpr int kFrames = 60, kSlices = 4, kLag = kSlices;
    Scene scene;
    add(scene, square(), white_ground(), flat_at(-1.2f));
    place(scene, make_volume("smoothed-sphere,resolution=32"));
    const auto sun_at = [](int frame) {
        Light light = sun();
        light.direction = glm::normalize(glm::vec3(0.3f + 0.004f * float(frame), -1.0f, -0.2f));
        return std::vector<Light>{light};
    };
    scene.lights = sun_at(0);
    const auto draw_small = [&](double slices) {
        RenderSettings settings;
        settings.width = settings.height = 48;
        settings.technique = "ihrke-2007";
        settings.parameters = {{"light-slices", slices}, {"branches", 0}};
        return renderer().render(settings).radiance;
    };
    std::vector<Image> shown, exact;
    for (const int slices : {1, kSlices}) {
        set(scene, uniform_environment(glm::vec3(0.1f)));
        std::vector<Image>& pictures = slices == 1 ? exact : shown;
        for (int frame = 0; frame < kFrames; ++frame) {
            renderer().set_lights(sun_at(frame));
            pictures.push_back(draw_small(slices));
        }
    }
    // Lights that are set are as those of the scene; what is out of range changes nothing.
    scene.lights = sun_at(kFrames - 1);
    set(scene, uniform_environment(glm::vec3(0.1f)));
    EXPECT_EQ(draw_small(1).pixels, exact.back().pixels);
    std::vector<Light> bad = sun_at(0);
    bad[0].intensity.r = -1.0f;
    EXPECT_THROW(renderer().set_lights(bad), Error);
    EXPECT_EQ(draw_small(1).pixels, exact.back().pixels);

    const auto display = [](float radiance) { return std::pow(std::min(double(radiance), 1.0), 1.0 / 2.2); };
    double flicker = 0.0;
    int oldest = 0, changes = 0;
    for (int t = 0; t < kFrames; ++t) {
        int age = 0;
        while (age <= t && shown[std::size_t(t)].pixels != exact[std::size_t(t - age)].pixels) ++age;
        EXPECT_LE(age, t < kSlices ? t : 2 * kSlices - 2) << "frame " << t << " is that of no moment";
        oldest = std::max(oldest, age);
        if (t < 2 * kLag) continue;
        changes += shown[std::size_t(t)].pixels != shown[std::size_t(t - 1)].pixels ? 1 : 0;
        double sum = 0.0;
        for (std::size_t i = 0; i < shown[0].pixels.size(); ++i) {
            const auto change = [&](const std::vector<Image>& frames, int at) {
                return display(frames[std::size_t(at)].pixels[i]) - display(frames[std::size_t(at - 1)].pixels[i]);
            };
            sum += std::abs(change(shown, t) - change(exact, t - kLag));
        }
        flicker = std::max(flicker, sum / double(shown[0].pixels.size()));
    }
    std::printf("moving light: oldest %d frames, %d changes, flicker %.5f (1/255 is %.5f)\n", oldest, changes, flicker,
                1.0 / 255.0);
    EXPECT_GT(oldest, 0);
    EXPECT_GT(changes, 5);
    EXPECT_LT(flicker, 1.0 / 255.0);
}

}  // namespace
}  // namespace pellucid::test
