// Technique kay-greenberg-1979 against its formulas. Under a uniform environment of radiance 1 a white surface's own
// colour is 1; a grey or a coloured background tells OLD from NEW.
#include "gpu/gpu_test.h"

#include "optics/interface.h"

#include <filesystem>

namespace pellucid::test {
namespace {

constexpr int kSize = 64;

Mesh square(float half) {
    Mesh mesh;
    mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

Material glass(glm::vec3 color) {
    Material material;
    material.transmission = 1.0f;
    material.thickness = 1.0f;
    material.base_color = glm::vec4(color, 1.0f);
    return material;
}

void add(Scene& scene, Mesh mesh, const Material& material, const glm::mat4& placement = glm::mat4(1.0f)) {
    Object object;
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    object.world_from_object = placement;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.objects.push_back(object);
}

/// Looks along -Z; `extent` metres fill the picture.
Camera front_camera(float extent) {
    Camera camera;
    camera.orthographic = true;
    camera.vertical_extent = extent;
    camera.world_from_view = glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, 8));
    return camera;
}

double reflectance(double cos_theta) { return fresnel_dielectric(cos_theta, 1.0 / 1.5); }

class KayGreenberg : public RendererTest {
protected:
    RenderResult render(const Scene& scene, const Camera& camera, const ParameterMap& parameters) {
        renderer().set_scene(scene);
        renderer().set_camera(camera);
        renderer().set_environment(uniform_environment());
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = "kay-greenberg-1979";
        settings.parameters = parameters;
        settings.paths = true;
        settings.aovs = {"normal"};
        return renderer().render(settings);
    }
    static const RefractedPath& path_at(const RenderResult& result, int x, int y) {
        return result.paths[std::size_t(y * kSize + x)];
    }
};

// Two surfaces of colour c over L: with OLD = L = 1 and NEW = c, tinted by c as all that comes through glass,
// r + c (t^2 + (1 - t) t + (1 - t)) and the reflection r; the first NEW is the surface's own colour once.
TEST_F(KayGreenberg, SphereFollowsTheLinearAndTheNonLinearFormula) {
    Scene scene = load_scene("shape:sphere,segments=128");
    const float c = 0.5f;
    scene.materials[0].base_color = {c, c, c, 1.0f};
    for (const double mode : {0.0, 1.0}) {
        const double least = 0.1, most = 0.8, power = 3.0;
        const RenderResult result =
            render(scene, front_camera(2.5f),
                   {{"mode", mode}, {"min-transparency", least}, {"max-transparency", most}, {"power", power}});
        int covered = 0;
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const RefractedPath& path = path_at(result, x, y);
                const double nz = double(rgb(result.aovs.at("normal"), x, y).z);
                if (path.events == 0 || nz < 0.2) continue;
                ++covered;
                ASSERT_EQ(path.events, 2);
                ASSERT_EQ(path.status, Status::kOk);
                // Seen along Z, front and back have the same |N.z|.
                const double t = mode == 0.0 ? most : (most - least) * (1.0 - std::pow(1.0 - nz, power)) + least;
                EXPECT_NEAR(path.transmittance.r, t * t, 4e-3);
                const double expected = reflectance(nz) + double(c) * (t * t + (1.0 - t) * (1.0 + t));
                EXPECT_NEAR(rgb(result.radiance, x, y).g, expected, 4e-3) << x << "," << y;
                EXPECT_LT(angle_deg(path.direction, {0, 0, -1}), 1e-3);
            }
        }
        EXPECT_GT(covered, 1000);
    }
}

// NEW and OLD of different colours: red glass over a blue background that is read where the pixel is.
TEST_F(KayGreenberg, OwnColourAndBackgroundAreMixed) {
    Scene scene;
    add(scene, square(0.5f), glass({0.8f, 0.4f, 0.2f}));
    add(
        scene, square(5.0f),
        [] {
            Material paint;
            paint.base_color = {0.1f, 0.2f, 0.9f, 1.0f};
            paint.unlit = true;
            return paint;
        }(),
        glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -1)));
    const RenderResult result = render(scene, front_camera(2.0f), {{"mode", 0}, {"max-transparency", 0.7}});
    const glm::vec3 c(0.8f, 0.4f, 0.2f), old(0.1f, 0.2f, 0.9f);
    const glm::vec3 expected = float(reflectance(1.0)) + c * (0.7f * old) + 0.3f * c;
    EXPECT_LT(glm::distance(rgb(result.radiance, kSize / 2, kSize / 2), expected), 2e-3f);
    EXPECT_EQ(path_at(result, kSize / 2, kSize / 2).object, 1);
}

// One tilted surface is a slab: the view moves by d T.xy, d = h / (-N.T), and T1^d is left.
TEST_F(KayGreenberg, TiltedSlabDisplacesByTheFormula) {
    const double tilt = 0.7, share = 0.2, transmission = 0.5;
    Scene scene;
    add(scene, square(1.0f), glass(glm::vec3(1.0f)),
        glm::rotate(glm::mat4(1.0f), float(tilt), glm::normalize(glm::vec3(1.0f, 1.0f, 0.0f))));
    const RenderResult result =
        render(scene, front_camera(2.0f), {{"mode", 2}, {"slab-thickness", share}, {"transmission", transmission}});
    // Glass radius: half the diagonal of the box around the tilted square's corners.
    const Bounds bounds = scene_bounds(scene);
    const double radius = double(glm::length(bounds.half_size)), h = share * radius;
    const glm::dvec3 n = glm::dmat3(scene.objects[0].world_from_object) * glm::dvec3(0, 0, 1);
    glm::dvec3 inside{};
    ASSERT_TRUE(refract_direction(glm::dvec3(0, 0, -1), n, 1.0 / 1.5, inside));
    const double d = h / -glm::dot(n, inside);
    const RefractedPath& path = path_at(result, kSize / 2, kSize / 2);
    const glm::dvec2 centre(0.5 * 2.0 / kSize, -0.5 * 2.0 / kSize);  // of the pixel, m from the axis
    EXPECT_NEAR(double(path.position.x) - centre.x, d * inside.x, 1e-4);
    EXPECT_NEAR(double(path.position.y) - centre.y, d * inside.y, 1e-4);
    EXPECT_GT(glm::length(glm::dvec2(inside)) * d, 0.05);
    EXPECT_NEAR(double(path.length_inside), d, 1e-4);
    EXPECT_NEAR(double(path.transmittance.g), std::pow(transmission, d / radius), 1e-4);
    EXPECT_EQ(path.status, Status::kMissingLayer);  // a single sheet is open
}

// A picture of stripes behind: the pixel shows the stripe at the displaced place, and its own one without thickness.
TEST_F(KayGreenberg, BackgroundIsReadWhereTheViewIsDisplacedTo) {
    Scene scene;
    const glm::mat4 tilted = glm::rotate(glm::mat4(1.0f), 0.9f, glm::vec3(0, 1, 0));
    add(scene, square(0.8f), glass(glm::vec3(1.0f)), tilted);
    Material left, right;
    left.unlit = right.unlit = true;
    left.base_color = {0.0f, 1.0f, 0.0f, 1.0f};
    right.base_color = {1.0f, 0.0f, 0.0f, 1.0f};
    add(scene, square(2.0f), left, glm::translate(glm::mat4(1.0f), glm::vec3(-2, 0, -3)));
    add(scene, square(2.0f), right, glm::translate(glm::mat4(1.0f), glm::vec3(2, 0, -3)));
    ParameterMap parameters = {{"mode", 2}, {"slab-thickness", 0.3}, {"transmission", 1}};
    const RenderResult thick = render(scene, front_camera(2.0f), parameters);
    parameters["slab-thickness"] = 0;
    const RenderResult thin = render(scene, front_camera(2.0f), parameters);
    const float r = float(reflectance(std::cos(0.9)));
    int moved = 0;
    for (int x = 0; x < kSize; ++x) {
        const RefractedPath &a = path_at(thick, x, kSize / 2), &b = path_at(thin, x, kSize / 2);
        if (a.events == 0) continue;
        const auto seen = [&](const RenderResult& result) { return rgb(result.radiance, x, kSize / 2) - r; };
        const bool own_right = x >= kSize / 2;
        EXPECT_EQ(b.object, own_right ? 2 : 1) << x;
        EXPECT_NEAR(seen(thin).r, own_right ? 1.0f : 0.0f, 2e-3f) << x;
        const bool displaced_right = a.position.x > 0.0f;
        EXPECT_EQ(a.object, displaced_right ? 2 : 1) << x;
        EXPECT_NEAR(seen(thick).r, displaced_right ? 1.0f : 0.0f, 2e-3f) << x;
        EXPECT_NEAR(seen(thick).g, displaced_right ? 0.0f : 1.0f, 2e-3f) << x;
        moved += own_right != displaced_right ? 1 : 0;
    }
    EXPECT_GT(moved, 3);
}

TEST_F(KayGreenberg, WithoutThicknessTheBackgroundIsUnchanged) {
    const Scene scene = load_scene("shape:knot");
    const RenderResult result = render(scene, front_camera(3.0f), {{"mode", 2}, {"slab-thickness", 0}, {"layers", 16}});
    EXPECT_GT(result.covered, 300u);
    EXPECT_EQ(result.status[std::size_t(Status::kOk)], result.covered);
    for (int i = 0; i < kSize * kSize; ++i) {
        const RefractedPath& path = result.paths[std::size_t(i)];
        EXPECT_LT(angle_deg(path.direction, {0, 0, -1}), 1e-3);
        EXPECT_EQ(path.length_inside, 0.0f);
        EXPECT_TRUE(path.events == 0 || path.transmittance == glm::vec3(1.0f)) << i;
    }
}

TEST_F(KayGreenberg, SurfacesBeyondTheLayersAreCounted) {
    const Scene scene = load_scene("shape:hollow-sphere");
    for (const auto& [layers, status] :
         {std::pair(4.0, Status::kOk), std::pair(3.0, Status::kEventLimit), std::pair(2.0, Status::kEventLimit)}) {
        const RenderResult result = render(scene, front_camera(2.5f), {{"mode", 1}, {"layers", layers}});
        const RefractedPath& middle = path_at(result, kSize / 2, kSize / 2);
        EXPECT_EQ(middle.events, int(layers));
        EXPECT_EQ(middle.status, status);
    }
}

/// Two squares that face the eye, one behind the other, under a sun alone.
class KayGreenbergLights : public KayGreenberg {
protected:
    static constexpr double kAlpha = 0.2 * 0.2;  // of the default highlight-roughness
    const glm::dvec3 color_{0.8, 0.4, 0.2};

    /// Radiance in the middle, under irradiance 2 from a sun `angle` off the view axis; parallel view rays.
    glm::dvec3 middle(double angle, double t, ParameterMap parameters = {}) {
        Scene scene;
        for (const float z : {0.0f, -1.0f})
            add(scene, square(1.0f), glass(glm::vec3(color_)), glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, z)));
        Light sun;
        sun.kind = Light::Kind::kDirectional;
        sun.intensity = glm::vec3(2.0f);
        sun.angular_diameter = 0.0f;  // it does not show itself
        sun.direction = glm::vec3(float(std::sin(angle)), 0.0f, -float(std::cos(angle)));
        scene.lights = {sun};
        renderer().set_scene(scene);
        renderer().set_camera(front_camera(1.0f));
        renderer().set_environment(uniform_environment(glm::vec3(0.0f)));
        RenderSettings settings;
        settings.width = settings.height = 8;
        settings.technique = "kay-greenberg-1979";
        settings.parameters = std::move(parameters);
        settings.parameters.try_emplace("mode", 0.0);
        settings.parameters["max-transparency"] = t;
        const RenderResult result = renderer().render(settings);
        return glm::dvec3(rgb(result.radiance, 4, 4));
    }
    /// The highlight of one surface, from the definitions: GGX facets half-way, masked from both sides.
    static double highlight(double angle) {
        const double facet = std::cos(0.5 * angle), light = std::cos(angle), alpha2 = kAlpha * kAlpha;
        const double density = alpha2 / (kPi * std::pow(facet * facet * (alpha2 - 1.0) + 1.0, 2));
        const auto lambda = [&](double cosine) {
            return 0.5 * (std::sqrt(1.0 + alpha2 * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
        };
        const double unmasked = 1.0 / (1.0 + lambda(1.0) + lambda(light));
        return 2.0 * light * density * unmasked * reflectance(facet) / (4.0 * light);
    }
    static void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
        EXPECT_LT(glm::length(found - expected), 1e-3 * (1.0 + glm::length(expected)))
            << found.x << ' ' << found.y << ' ' << found.z << " against " << expected.x << ' ' << expected.y << ' '
            << expected.z;
    }
};

// The nearer surface's colour in full, the one behind it tinted by it: see SphereFollowsTheLinearAndTheNonLinearFormula.
TEST_F(KayGreenbergLights, NewFollowsTheAngleToTheLightAndHighlightsOfBothSurfacesAreAdded) {
    for (const double angle : {0.0, 0.1, 0.5, 1.3}) {
        for (const double t : {0.0, 0.3, 0.9}) {
            const double lambert = 2.0 * std::cos(angle) / kPi;
            expect_near(middle(angle, t), color_ * (lambert * (1.0 - t) * (1.0 + t)) + 2.0 * highlight(angle));
        }
    }
}

TEST_F(KayGreenbergLights, LightFromBehindDoesNotShow) {
    EXPECT_EQ(middle(kPi, 0.5), glm::dvec3(0.0));
    EXPECT_EQ(middle(2.0, 0.5), glm::dvec3(0.0));
}

TEST_F(KayGreenbergLights, HighlightsAreAsWideAsTheParameterSays) {
    const glm::dvec3 sharp = middle(0.6, 1.0, {{"highlight-roughness", 0.1}});
    const glm::dvec3 wide = middle(0.6, 1.0, {{"highlight-roughness", 0.6}});
    EXPECT_GT(wide.r, 20.0 * sharp.r);
}

// Lights can be set anew, and taken away, on one scene.
TEST_F(KayGreenbergLights, ChangedLightsAreDrawn) {
    const double lit = middle(0.5, 0.5).r;
    RenderSettings settings;
    settings.width = settings.height = 8;
    settings.technique = "kay-greenberg-1979";
    settings.parameters = {{"mode", 0}, {"max-transparency", 0.5}};
    Light sun;
    sun.kind = Light::Kind::kDirectional;
    sun.intensity = glm::vec3(2.0f);
    sun.angular_diameter = 0.0f;
    sun.direction = glm::vec3(float(std::sin(0.5)), 0.0f, -float(std::cos(0.5)));
    renderer().set_lights({sun, sun, sun});
    EXPECT_NEAR(double(rgb(renderer().render(settings).radiance, 4, 4).r), 3.0 * lit, 1e-4);
    renderer().set_lights({});
    EXPECT_EQ(rgb(renderer().render(settings).radiance, 4, 4), glm::vec3(0.0f));
}

// With own slabs h is thicknessFactor in the world, and t what the material's absorption leaves of d.
TEST_F(KayGreenberg, OwnSlabsAreOfTheMaterial) {
    Scene scene;
    Material material = glass(glm::vec3(1.0f));
    material.thickness = 0.1f;
    material.attenuation_color = glm::vec3(0.5f, 0.25f, 1.0f);
    material.attenuation_distance = 0.2f;
    add(scene, square(0.5f), material, glm::scale(glm::mat4(1.0f), glm::vec3(2.0f)));
    const RenderResult result = render(scene, front_camera(1.0f), {{"mode", 2}, {"own-slabs", 1}});
    const RefractedPath& path = path_at(result, kSize / 2, kSize / 2);
    EXPECT_NEAR(path.length_inside, 0.2f, 1e-5f);
    EXPECT_NEAR(path.transmittance.r, 0.5f, 1e-5f);
    EXPECT_NEAR(path.transmittance.g, 0.25f, 1e-5f);
    EXPECT_NEAR(path.transmittance.b, 1.0f, 1e-5f);
}

TEST_F(KayGreenberg, EveryModelIsFinite) {
    const char* data = std::getenv("PELLUCID_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "PELLUCID_TEST_DATA is not set";
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(data) / "models")) {
        const std::string kind = entry.path().extension().string();
        if (kind != ".obj" && kind != ".ply" && kind != ".off") continue;
        const Scene scene = load_scene(entry.path().string());
        for (const double mode : {0.0, 1.0, 2.0}) {
            const float fov = 0.5235988f;
            const Camera camera = orbit_camera(scene_bounds(scene), 20, 15, framing_distance(fov, 0.7f), fov);
            const RenderResult result = render(scene, camera, {{"mode", mode}});
            EXPECT_TRUE(all_finite(result.radiance)) << entry.path();
            std::uint64_t covered = 0;
            for (const RefractedPath& path : result.paths) {
                covered += path.events > 0 ? 1 : 0;
                ASSERT_NEAR(glm::length(path.direction), 1.0f, 1e-4f) << entry.path();
            }
            EXPECT_EQ(covered, result.covered) << entry.path();
        }
    }
}

}  // namespace
}  // namespace pellucid::test
