// Techniques against analytic answers.
#include "gpu/exact_sphere.h"

#include <algorithm>
#include <array>

namespace pellucid::test {
namespace {

constexpr double kIor = 1.5;

RenderSettings settings_for(std::string technique, std::uint32_t size) {
    RenderSettings settings;
    settings.width = settings.height = size;
    settings.technique = std::move(technique);
    settings.aovs = {"exit-direction", "exit-position", "path-length", "events", "status",
                     "depth",          "normal",        "object",      "layers"};
    return settings;
}

class Refraction : public RendererTest {
protected:
    RenderResult render(const std::string& scene, const RenderSettings& settings, const Camera& camera,
                        const LoadOptions& options = {}) {
        renderer().set_scene(load_scene(scene, options));
        renderer().set_camera(camera);
        renderer().set_environment(uniform_environment());
        return renderer().render(settings);
    }
};

Camera framing(const std::string& scene, float azimuth_deg, float elevation_deg, float share = 0.7f) {
    const float fov = 0.5235988f;
    return orbit_camera(scene_bounds(load_scene(scene)), azimuth_deg, elevation_deg, framing_distance(fov, share), fov);
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

TEST_F(Refraction, SphereExitsWhereTheFormulaSays) {
    constexpr int kSize = 512;
    // Fine enough that facets do not matter: normals are those of the sphere, and the surface lies
    // within 2e-5 radii of it.
    const std::string scene = "shape:sphere,segments=160";
    const Camera camera = framing(scene, 30.0f, 15.0f);
    const RenderResult result = render(scene, settings_for("wang-2014", kSize), camera);
    int covered = 0, right = 0;
    double worst_position = 0.0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            if (rgb(result.aovs.at("events"), x, y).x == 0.0f) continue;
            const auto exact = through_unit_sphere(pixel_ray(camera, kSize, kSize, x, y), kIor);
            if (!exact) continue;  // the pixel's ray misses the sphere that the mesh stands for
            ++covered;
            const bool good = angle_deg(rgb(result.aovs.at("exit-direction"), x, y), exact->direction) <= 1.0;
            right += good ? 1 : 0;
            if (!good) continue;
            worst_position = std::max(
                worst_position, glm::distance(glm::dvec3(rgb(result.aovs.at("exit-position"), x, y)), exact->position));
            EXPECT_NEAR(*result.aovs.at("path-length").at(x, y), exact->length, 0.05);
        }
    }
    EXPECT_GT(covered, 90000);
    EXPECT_GE(double(right) / covered, 0.999);
    EXPECT_LT(worst_position, 0.05);  // metres; one pixel is 0.006 m wide here and the search is by depth
}

TEST_F(Refraction, OneInterfaceBendsAsSnellSays) {
    constexpr int kSize = 128;
    const std::string scene = "shape:torus";
    const Camera camera = framing(scene, 0.0f, 15.0f);
    const RenderResult result = render(scene, settings_for("one-interface", kSize), camera);
    int covered = 0;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const glm::dvec3 incident = pixel_ray(camera, kSize, kSize, x, y).direction;
            const glm::dvec3 exit(rgb(result.aovs.at("exit-direction"), x, y));
            if (rgb(result.aovs.at("events"), x, y).x == 0.0f) {
                EXPECT_LT(angle_deg(exit, incident), 0.01);  // no glass: the view ray itself
                continue;
            }
            ++covered;
            glm::dvec3 expected{};
            const glm::dvec3 normal(rgb(result.aovs.at("normal"), x, y));
            ASSERT_TRUE(refract_direction(incident, normal, 1.0 / kIor, expected));
            EXPECT_LT(angle_deg(exit, expected), 0.05) << x << "," << y;
        }
    }
    EXPECT_GT(covered, 3000);
}

// A plane-parallel slab: the ray leaves in its old direction, shifted sideways by
// t sin(i) (1 - cos(i) / sqrt(n^2 - sin^2(i))).
TEST_F(Refraction, SlabShiftsTheRaySideways) {
    constexpr int kSize = 65;
    const double angle = 0.6, thickness = 0.3;
    const Camera camera = parallel_camera(float(angle), 0.4f);
    const std::string scene = "shape:slab,width=2,height=2,thickness=0.3";
    const RenderResult result = render(scene, settings_for("wang-2014", kSize), camera);

    const int center = kSize / 2;
    const glm::dvec3 direction = -glm::dvec3(camera.world_from_view[2]);
    const glm::dvec3 exit(rgb(result.aovs.at("exit-position"), center, center));
    EXPECT_LT(angle_deg(rgb(result.aovs.at("exit-direction"), center, center), direction), 0.01);
    EXPECT_EQ(rgb(result.aovs.at("status"), center, center).x, 0.0f);
    EXPECT_EQ(rgb(result.aovs.at("events"), center, center).x, 2.0f);

    // The central ray passes through the origin; distance of the exit point from that line.
    const double shift = glm::length(glm::cross(exit, direction));
    const double s = std::sin(angle);
    const double expected = thickness * s * (1.0 - std::cos(angle) / std::sqrt(kIor * kIor - s * s));
    EXPECT_NEAR(shift, expected, 1e-3);  // the search ends within a fraction of a step of the surface
    const double cos_t = std::sqrt(1.0 - s * s / (kIor * kIor));
    EXPECT_NEAR(*result.aovs.at("path-length").at(center, center), thickness / cos_t, 2e-3);
}

TEST_F(Refraction, AbsorptionAndFresnelThroughASlab) {
    LoadOptions options;
    options.attenuation_color = glm::vec3(0.2f, 0.5f, 0.9f);
    options.attenuation_distance = 0.5f;
    const double thickness = 0.3;
    const RenderResult result = render("shape:slab,width=2,height=2,thickness=0.3", settings_for("wang-2014", 33),
                                       parallel_camera(0.0f, 0.4f), options);
    const double reflectance = std::pow((kIor - 1.0) / (kIor + 1.0), 2.0);
    for (int c = 0; c < 3; ++c) {
        const double absorbed = std::pow(double((*options.attenuation_color)[c]), thickness / 0.5);
        const double expected = (1.0 - reflectance) * (1.0 - reflectance) * absorbed + reflectance;
        EXPECT_NEAR(rgb(result.radiance, 16, 16)[c], expected, 3e-3) << c;
    }
}

// At one interface nothing is lost: what is not refracted is reflected.
TEST_F(Refraction, OneInterfaceIsInvisibleInAUniformEnvironment) {
    for (const char* scene : {"shape:goblet", "shape:gem", "shape:knot"}) {
        const RenderResult result = render(scene, settings_for("one-interface", 64), framing(scene, 10.0f, 15.0f));
        EXPECT_GT(result.covered, 100u);
        for (const float value : result.radiance.pixels) ASSERT_NEAR(value, 1.0f, 2e-4f) << scene;
    }
}

// Looking along a prism's axis of symmetry: at 45 degrees glass reflects totally.
TEST_F(Refraction, CubeReflectsTotallyBehindTheCriticalAngle) {
    const std::string scene = "shape:cube";
    const RenderResult result = render(scene, settings_for("wang-2014", 128), framing(scene, 45.0f, 0.0f));
    std::uint64_t reflected = 0;
    const Image& events = result.aovs.at("events");
    for (std::size_t i = 0; i < events.pixels.size(); i += 2) reflected += events.pixels[i + 1] > 0.0f ? 1 : 0;
    // Rays that enter a side face at 45 degrees run at 28.1 degrees inside and meet the neighbouring
    // side at 61.9, beyond the critical 41.8 degrees; those that meet the opposite one pass.
    EXPECT_GT(double(reflected) / double(result.covered), 0.2);
}

TEST_F(Refraction, StatusIsSetWhereAnInterfaceIsMissing) {
    // The eye inside the glass: the entry before the first surface is nowhere.
    Camera camera;
    const RenderResult inside = render("shape:sphere", settings_for("wang-2014", 32), camera);
    EXPECT_EQ(inside.covered, 32u * 32u);
    EXPECT_EQ(inside.status[std::size_t(Status::kMissingLayer)], inside.covered);
    // So close that paths leave the picture inside the glass.
    const RenderResult close =
        render("shape:torus", settings_for("wang-2014", 64), framing("shape:torus", 0.0f, 0.0f, 0.99f));
    EXPECT_GT(close.status[std::size_t(Status::kOk)], 0u);
    std::uint64_t sum = 0;
    for (const std::uint64_t count : close.status) sum += count;
    EXPECT_EQ(sum, close.covered);
}

TEST_F(Refraction, MoreLayersFollowMoreInterfaces) {
    const std::string scene = "shape:hollow-sphere";
    RenderSettings settings = settings_for("wang-2014", 64);
    const auto most_events = [&](double layers) {
        settings.parameters["layers"] = layers;
        const RenderResult result = render(scene, settings, framing(scene, 0.0f, 0.0f));
        const Image& events = result.aovs.at("events");
        return rgb(events, 32, 32).x;
    };
    EXPECT_EQ(most_events(2), 2.0f);
    EXPECT_EQ(most_events(4), 4.0f);
}

}  // namespace
}  // namespace pellucid::test
