// Light of suns, lamps and spots on opaque surfaces in frames, against closed forms and the path tracer.
#include "closed_form/lights.h"
#include "gpu/gpu_test.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>

namespace pellucid::test {
namespace {

constexpr int kSize = 64;
constexpr double kFloor = -1.0;  // its height, m

Material diffuse(glm::vec3 albedo = glm::vec3(0.8f)) {
    Material material;
    material.base_color = glm::vec4(albedo, 1.0f);
    material.roughness = 1.0f;
    material.ior = 1.0f;  // no coat: all that the surface reflects is diffuse
    return material;
}

Material glass(float attenuation = 1.0f) {
    Material material;
    material.transmission = 1.0f;
    material.thickness = 1.0f;
    material.ior = 1.5f;
    material.attenuation_color = glm::vec3(attenuation);
    material.attenuation_distance = 1.0f;
    return material;
}

struct Box {
    glm::dvec3 low, high;

    /// Whether a ray from `x` meets it.
    bool meets(const glm::dvec3& x, const glm::dvec3& d, double margin) const {
        const glm::dvec3 s = (low - margin - x) / d, t = (high + margin - x) / d;
        const glm::dvec3 nearer = glm::min(s, t), farther = glm::max(s, t);
        const double near = std::max({nearer.x, nearer.y, nearer.z, 0.0});
        return near < std::min({farther.x, farther.y, farther.z});
    }
};

class DirectLight : public TechniqueTest {
protected:
    void SetUp() override {
        TechniqueTest::SetUp();
        if (IsSkipped()) return;
        const Scene box = load_scene("shape:cube");
        scene_.meshes = box.meshes;
        box_ = scene_bounds(box);
        add(diffuse(), {{-4.0, kFloor - 0.1, -4.0}, {4.0, kFloor, 4.0}});
        const float fov = Camera{}.vertical_fov;
        camera_ = orbit_camera(scene_bounds(scene_), 20.0f, 50.0f, framing_distance(fov, 0.9f), fov);
    }
    void add(const Material& material, const Box& box) {
        Object object;
        object.mesh = 0;
        object.material = int(scene_.materials.size());
        const glm::mat4 moved = glm::translate(glm::mat4(1.0f), glm::vec3(0.5 * (box.low + box.high)));
        const glm::mat4 scaled = glm::scale(moved, glm::vec3(0.5 * (box.high - box.low)) / box_.half_size);
        object.world_from_object = glm::translate(scaled, -box_.center);
        scene_.materials.push_back(material);
        scene_.objects.push_back(object);
        boxes_.push_back(box);
    }
    RenderResult draw(const LightOptions& light = {}, std::uint32_t samples = 1) {
        renderer().set_scene(scene_);
        renderer().set_environment(uniform_environment(glm::vec3(environment_)));
        renderer().set_camera(camera_);
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = GetParam();
        settings.samples = samples;
        settings.light = light;
        return renderer().render(settings);
    }
    /// The scene that draw() has set, by the path tracer.
    RenderResult trace(std::uint32_t samples) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = "path";
        settings.samples = samples;
        return renderer().render(settings);
    }
    /// Calls check(x, y, position) for pixels that show the top of the floor, 0.05 m or more from all edges that are seen.
    template <class Check>
    int for_each_floor_pixel(Check check) const {
        int count = 0;
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
                const glm::dvec3 p = ray.origin + ((kFloor - ray.origin.y) / ray.direction.y) * ray.direction;
                bool hidden = std::max(std::abs(p.x), std::abs(p.z)) > 3.9;
                for (std::size_t i = 1; i < boxes_.size(); ++i)
                    hidden = hidden || boxes_[i].meets(ray.origin, ray.direction, 0.05);
                if (hidden) continue;
                ++count;
                check(x, y, p);
            }
        return count;
    }
    /// Whether a box lies between the floor and a light: 1 yes, 0 no, -1 too near its edge to say.
    int shadow_of(const Box& box, const glm::dvec3& from, const glm::dvec3& to_light) const {
        const bool surely = box.meets(from, to_light, -0.02), perhaps = box.meets(from, to_light, 0.02);
        return surely == perhaps ? int(surely) : -1;
    }

    Scene scene_;
    Camera camera_;
    float environment_ = 0.0f;
    std::vector<Box> boxes_;

private:
    Bounds box_;
};

constexpr double kAlbedo = 0.8;
constexpr float kRounding = 1e-4f;  // of single precision over some ten operations

// Radiance is albedo / pi times irradiance: E cos for a sun, I cos / d^2 for a lamp; nothing where an opaque box or, for
// exact shadows, glass is in between.
TEST_P(DirectLight, OpaqueAndGlassCastShadows) {
    add(diffuse(), {{-1.5, -0.5, -0.5}, {-0.7, 0.3, 0.5}});
    add(glass(), {{0.7, -0.5, -0.5}, {1.5, 0.3, 0.5}});
    for (const bool is_lamp : {false, true}) {
        const glm::vec3 towards(1.5f, 1.0f, -0.4f), position(2.5f, 2.0f, -0.8f);
        scene_.lights = {is_lamp ? lamp(position, 5.0f) : sun(-towards, 2.0f)};
        const RenderResult drawn = draw();
        int lit = 0, dark = 0;
        for_each_floor_pixel([&](int x, int y, const glm::dvec3& p) {
            const glm::dvec3 to_light = is_lamp ? glm::dvec3(position) - p : glm::dvec3(towards);
            const int first = shadow_of(boxes_[1], p, to_light), second = shadow_of(boxes_[2], p, to_light);
            if (first < 0 || second < 0) return;
            const double cosine = to_light.y / glm::length(to_light);
            const double irradiance = is_lamp ? 5.0 * cosine / glm::dot(to_light, to_light) : 2.0 * cosine;
            const double expected = first + second > 0 ? 0.0 : kAlbedo / double(kPi) * irradiance;
            ++(expected > 0.0 ? lit : dark);
            EXPECT_NEAR(rgb(drawn.radiance, x, y).g, expected, kRounding) << x << ", " << y;
        });
        EXPECT_GT(lit, 500);
        EXPECT_GT(dark, 50);
    }
}

// Straight down through a glass slab: twice 1 - R of normal incidence, 0.04, and exp(-sigma d).
TEST_P(DirectLight, TintedShadowsOfGlass) {
    add(glass(0.5f), {{-1.0, -0.5, -1.0}, {1.0, 0.0, 1.0}});
    scene_.lights = {sun({0.0f, -1.0f, 0.0f}, 2.0f)};
    LightOptions light;
    light.shadows = Shadows::kTinted;
    const RenderResult drawn = draw(light);
    int shadowed = 0;
    for_each_floor_pixel([&](int x, int y, const glm::dvec3& p) {
        const int shadow = shadow_of(boxes_[1], p, {1e-9, 1.0, 1e-9});
        if (shadow < 0) return;
        shadowed += shadow;
        const double passes = shadow == 1 ? 0.96 * 0.96 * std::sqrt(0.5) : 1.0;
        EXPECT_NEAR(rgb(drawn.radiance, x, y).g, kAlbedo / double(kPi) * 2.0 * passes, kRounding) << x << ", " << y;
    });
    EXPECT_GE(shadowed, 10);
}

// A pane reflects 2 F / (1 + F) of light that falls on it straight, in both kinds of shadow.
TEST_P(DirectLight, PanesLetLightPass) {
    Material pane = glass();
    pane.thickness = 0.0f;
    pane.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    add(pane, {{-1.0, -0.5, -1.0}, {1.0, 0.0, 1.0}});  // two panes, one above the other
    scene_.lights = {sun({0.0f, -1.0f, 0.0f}, 2.0f)};
    const RenderResult drawn = draw();
    int shadowed = 0;
    for_each_floor_pixel([&](int x, int y, const glm::dvec3& p) {
        const int shadow = shadow_of(boxes_[1], p, {1e-9, 1.0, 1e-9});
        if (shadow < 0) return;
        shadowed += shadow;
        const double passes = shadow == 1 ? std::pow(0.5 * (1.0 - 0.08 / 1.04), 2.0) : 1.0;
        EXPECT_NEAR(rgb(drawn.radiance, x, y).g, kAlbedo / double(kPi) * 2.0 * passes, kRounding) << x << ", " << y;
    });
    EXPECT_GE(shadowed, 10);
}

/// Share of a disc of radius 1 on one side of a chord, at a distance of `chord` from the middle, which is on that side.
double share_of_disc(double chord) {
    const double d = std::min(chord, 1.0);
    return 1.0 - (std::acos(d) - d * std::sqrt(1.0 - d * d)) / double(kPi);
}

// The edge of a box hides a part of a lamp's ball: half of it right below the edge, and less farther out. 256 samples, over
// some pixels: below 0.03.
TEST_P(DirectLight, LampsWithARadiusCastSoftShadows) {
    add(diffuse(), {{-3.0, 0.4, -1.0}, {0.0, 0.5, 1.0}});
    scene_.lights = {lamp({0.0f, 2.0f, 0.0f}, 5.0f, 0.5f)};
    const RenderResult soft = draw({}, 256);
    double at_edge = 0.0, beside = 0.0, beyond = 0.0, least = 0.0, most = 0.0;
    int edge = 0, partly = 0, free = 0;
    for_each_floor_pixel([&](int x, int y, const glm::dvec3& p) {
        if (std::abs(p.z) > 0.5) return;
        const double unshadowed = kAlbedo / double(kPi) * 5.0 * 27.0 / std::pow(9.0 + p.x * p.x + p.z * p.z, 1.5) / 9.0;
        const double share = double(rgb(soft.radiance, x, y).g) / unshadowed;
        if (std::abs(p.x) < 0.03) at_edge += share, ++edge;
        if (p.x > 1.2) beyond += share, ++free;
        if (p.x < 0.1 || p.x > 0.4) return;
        beside += share, ++partly;
        // The edges of the box lie at 1.4 and 1.5 m of the lamp's 3 m above the floor: seen from p, one of them hides most.
        least += share_of_disc(p.x / 0.5);
        most += share_of_disc(p.x * (3.0 / 1.4 - 1.0) / 0.5);
    });
    ASSERT_GT(edge, 0);
    ASSERT_GT(partly, 3);
    ASSERT_GT(free, 10);
    EXPECT_NEAR(at_edge / edge, 0.5, 0.08);
    EXPECT_GT(beside / partly, least / partly - 0.03);
    EXPECT_LT(beside / partly, most / partly + 0.03);
    EXPECT_NEAR(beyond / free, 1.0, 0.02);
}

// What surfaces are seen to reflect through a slab of glass is what they reflect, less what the slab takes.
TEST_P(DirectLight, IsSeenThroughGlass) {
    if (!find_technique(GetParam()).whole_scene) GTEST_SKIP() << "sees through glass what the picture shows";
    scene_.lights = {lamp({3.0f, 0.5f, 0.0f}, 5.0f)};
    const RenderResult alone = draw();
    add(glass(), {{-1.0, 1.0, -1.0}, {1.0, 1.2, 1.0}});
    const RenderResult through = draw();
    int seen = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
            const Box inner{{-0.9, 1.19, -0.9}, {0.9, 1.2, 0.9}};
            if (!inner.meets(ray.origin, ray.direction, 0.0)) continue;
            const double before = double(rgb(alone.radiance, x, y).g), after = double(rgb(through.radiance, x, y).g);
            if (before == 0.0) continue;
            ++seen;
            // The slab moves the view by less than 0.1 m, over which the light changes by less than 15%; two faces pass 0.8
            // to 0.93 of it at up to 60 degrees.
            EXPECT_GT(after, 0.65 * before) << x << ", " << y;
            EXPECT_LT(after, 1.1 * before) << x << ", " << y;
        }
    EXPECT_GT(seen, 20);
}

// A lamp of some size between the eye and a slab of glass has its own radiance, I / (pi r^2).
TEST_P(DirectLight, LampsHideTheGlassBehindThem) {
    add(glass(), {{-1.0, -0.5, -1.0}, {1.0, 0.0, 1.0}});
    const glm::vec3 eye(camera_.world_from_view[3]), ahead(-camera_.world_from_view[2]);
    scene_.lights = {lamp(eye + ahead, 2.0f, 0.1f)};
    const double radiance = 2.0 / (double(kPi) * 0.01);
    EXPECT_NEAR(rgb(draw().radiance, kSize / 2, kSize / 2).g, radiance, double(kRounding) * radiance);
}

// Nine lamps, of which each sample chooses four at random, give in the mean what they give one by one.
TEST_P(DirectLight, ManyLightsAreChosenAtRandomWithoutBias) {
    std::vector<Light> all;
    for (int i = 0; i < 9; ++i)
        all.push_back(lamp({0.8f * float(i % 3) - 0.8f, 0.5f + 0.2f * float(i), 0.7f * float(i / 3)}, 1.0f + float(i)));
    double expected = 0.0, found = 0.0;
    for (const Light& each : all) {
        scene_.lights = {each};
        for (const float value : draw().radiance.pixels) expected += double(value);
    }
    scene_.lights = all;
    for (const float value : draw({}, 16).radiance.pixels) found += double(value);
    EXPECT_NEAR(found / expected, 1.0, 0.01);
}

// A bright plate above the floor, whose light the path tracer meets by chance: in the dark, and of one bounce.
TEST_P(DirectLight, EmissiveSurfacesLightOthers) {
    Material bright = diffuse(glm::vec3(0.0f));
    bright.emission = glm::vec3(3.0f, 2.0f, 1.0f);
    add(bright, {{-1.0, 0.5, -1.0}, {0.5, 0.6, 1.0}});
    LightOptions light;
    light.transport = LightTransport::kDirect;
    const RenderResult found = draw(light, 64);
    const RenderResult truth = trace(256);
    glm::dvec3 sum_found(0.0), sum_truth(0.0);
    for_each_floor_pixel([&](int x, int y, const glm::dvec3&) {
        sum_found += rgb(found.radiance, x, y);
        sum_truth += rgb(truth.radiance, x, y);
    });
    // The plate reflects nothing, so there is no other light.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum_found[c] / sum_truth[c], 1.0, 0.01) << "channel " << c;
}

// A grey floor under a white sky, with a box on it: diffuse reflections between them, and what the box hides of the sky.
TEST_P(DirectLight, BouncesAgreeWithThePathTracer) {
    environment_ = 1.0f;
    add(diffuse({0.9f, 0.3f, 0.2f}), {{-0.5, kFloor, -0.5}, {0.5, 0.0, 0.5}});
    scene_.lights = {sun({-1.0f, -1.0f, -0.5f}, 1.0f)};
    LightOptions light;
    light.transport = LightTransport::kFull;
    light.bounces = 6;
    const RenderResult found = draw(light, 128);
    const RenderResult truth = trace(128);
    glm::dvec3 sum_found(0.0), sum_truth(0.0);
    double difference = 0.0, light_of_all = 0.0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const glm::dvec3 a(rgb(found.radiance, x, y)), b(rgb(truth.radiance, x, y));
            sum_found += a, sum_truth += b;
            difference += std::abs(a.g - b.g), light_of_all += b.g;
        }
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum_found[c] / sum_truth[c], 1.0, 0.005) << "channel " << c;
    EXPECT_LT(difference / light_of_all, 0.03);
}

INSTANTIATE_TEST_SUITE_P(Techniques, DirectLight,
                         ::testing::Values("visibility-layers", "visibility-cube", "ray-tracing-cpu", "ray-tracing",
                                           "wyman-2005", "wang-2014"),
                         technique_test_name);

}  // namespace
}  // namespace pellucid::test
