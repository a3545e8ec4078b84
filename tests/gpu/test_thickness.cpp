// Thickness by every method, against known lengths and against rays of Embree.
#include "gpu/gpu_test.h"
#include "unit/translucent_scenes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <functional>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 96;
constexpr std::array kLayered = {ThicknessMethod::kDepthPeeling, ThicknessMethod::kDualDepthPeeling,
                                 ThicknessMethod::kLayers};

const char* name_of(ThicknessMethod method) { return thickness_methods()[std::size_t(method)].name.data(); }

class Thickness : public RendererTest {
protected:
    void set(const Scene& scene, float azimuth_deg = 120.0f, float elevation_deg = 20.0f) {
        scene_ = scene;
        renderer().set_scene(scene_);
        renderer().set_environment(uniform_environment(glm::vec3(0.0f)));
        camera_ =
            orbit_camera(scene_bounds(scene_), azimuth_deg, elevation_deg, framing_distance(0.5236f, 0.9f), 0.5236f);
        renderer().set_camera(camera_);
    }
    ThicknessResult measure_all(ThicknessMethod method, std::uint32_t layers = 8, std::uint32_t resolution = 512) {
        return renderer().measure_thickness(
            {.width = kSize, .height = kSize, .settings = {method, layers, resolution}, .light = 0, .progress = {}});
    }
    Image measure(ThicknessMethod method, std::uint32_t layers = 8, std::uint32_t resolution = 512) {
        return measure_all(method, layers, resolution).thickness;
    }
    Image exact() const { return ThicknessTracer(scene_).trace(camera_, kSize, kSize, 0); }
    /// sum |d - d*| / sum d*, against rays.
    double error(ThicknessMethod method, std::uint32_t layers = 8, std::uint32_t resolution = 512) {
        return thickness_error(exact(), measure(method, layers, resolution)).relative;
    }
    const Camera& camera() const { return camera_; }
    const Scene& scene() const { return scene_; }

private:
    Scene scene_;
    Camera camera_;
};

// Chords of the ball itself; the mesh is inscribed, by 5e-5 of the radius. The plane of a triangle that a texel's centre
// sees is off the ball by half its bend times the square of the distance: with chord c that is 4 s^2 / c^3, s up to the
// diagonal of a texel and of a triangle.
TEST_F(Thickness, ChordsOfABall) {
    const glm::vec3 way = glm::normalize(glm::vec3(0.3f, -0.4f, -1.0f));
    set(waxen("shape:sphere,segments=128", sun(way)));
    const auto largest_error = [&](const Image& thickness, double s) {
        double largest = 0.0;  // beyond what is due to the bend
        int compared = 0;
        for (std::uint32_t y = 0; y < kSize; ++y) {
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const WorldRay ray = pixel_ray(camera(), kSize, kSize, x, y);
                const double b = glm::dot(ray.origin, ray.direction);
                const double root = b * b - glm::dot(ray.origin, ray.origin) + 1.0;
                if (root < 0.02) continue;  // the silhouette: a pixel on the ball may miss the mesh
                const glm::dvec3 point = ray.origin - (b + std::sqrt(root)) * ray.direction;
                const double chord = std::max(2.0 * glm::dot(point, glm::dvec3(way)), 0.0);
                largest = std::max(largest, std::abs(double(*thickness.at(int(x), int(y))) - chord) -
                                                4.0 * s * s / std::pow(std::max(chord, 0.05), 3.0));
                ++compared;
            }
        }
        EXPECT_GT(compared, 4000);
        return largest;
    };
    EXPECT_LT(largest_error(exact(), 0.0), 0.01);
    const double s = std::sqrt(2.0) * (2.0 / 512.0);
    for (const ThicknessMethod method : kLayered) EXPECT_LT(largest_error(measure(method), s), 0.01) << name_of(method);
}

// A slab 0.3 thick along the light, and aslant, where the way through is longer by the secant.
TEST_F(Thickness, ChordsOfASlab) {
    for (const float slant : {0.0f, 0.5f}) {
        const glm::vec3 way(std::sin(slant), 0.0f, -std::cos(slant));
        set(waxen("shape:slab", sun(way)), 170.0f, 10.0f);
        for (const ThicknessMethod method : kLayered) {
            const Image thickness = measure(method);
            int through = 0;
            for (const float d : thickness.pixels) {
                if (std::abs(double(d) - 0.3 / std::cos(double(slant))) < 1e-5) ++through;
            }
            EXPECT_GT(through, shares(thickness).translucent / 2) << name_of(method) << ", slant " << slant;
            EXPECT_LT(error(method), 2e-3) << name_of(method) << ", slant " << slant;
        }
    }
}

TEST_F(Thickness, GapsAreNotSolid) {
    // The cavity of a hollow ball, and the air between two balls.
    Scene balls = waxen("shape:sphere,segments=64", sun({0, 0, -1}));
    add_copy(balls, moved({0.3f, 0.1f, -3.0f}));
    for (const Scene& scene : {waxen("shape:hollow-sphere,segments=64,inner=0.8", sun({0.2f, 0.1f, -1})), balls}) {
        set(scene);
        for (const ThicknessMethod method : kLayered) EXPECT_LT(error(method), 5e-3) << name_of(method);
        EXPECT_GT(error(ThicknessMethod::kTranslucentShadowMap), 0.2);
    }
}

// Overlapping balls are one solid: what both fill counts once. The exact rays have it so, too.
TEST_F(Thickness, OverlapsCountOnce) {
    Scene scene = waxen("shape:sphere,segments=64", sun({0, 0, -1}));
    add_copy(scene, moved({0.0f, 0.0f, -1.0f}));
    set(scene, 180.0f, 0.0f);
    EXPECT_NEAR(double(*exact().at(kSize / 2, kSize / 2)), 3.0, 0.01);
    for (const ThicknessMethod method : kLayered) {
        EXPECT_NEAR(double(*measure(method).at(kSize / 2, kSize / 2)), 3.0, 0.01) << name_of(method);
        EXPECT_LT(error(method), 5e-3) << name_of(method);
    }
}

TEST_F(Thickness, TheLitSideIsExactlyZero) {
    for (const char* shape : {"shape:sphere,segments=24", "shape:sphere,segments=200", "shape:cube"}) {
        set(waxen(shape, sun({0.35f, -0.5f, -1.0f})), 20.0f, 10.0f);
        const Image truth = exact();
        ASSERT_GT(shares(truth).lit, 1000);
        for (const std::uint32_t resolution : {16u, 63u, 256u, 1024u}) {
            for (const ThicknessMethod method :
                 {ThicknessMethod::kLayers, ThicknessMethod::kDepthPeeling, ThicknessMethod::kTranslucentShadowMap}) {
                const Image thickness = measure(method, 8, resolution);
                int speckle = 0;
                for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
                    if (truth.pixels[i] == 0.0f && thickness.pixels[i] != 0.0f) ++speckle;
                }
                EXPECT_EQ(speckle, 0) << shape << ", " << name_of(method) << ", " << resolution;
            }
        }
    }
}

TEST_F(Thickness, TheUnitOfLengthDoesNotMatter) {
    Scene scene = waxen("shape:torus", sun({0.4f, -0.6f, -1.0f}));
    set(scene);
    const Image metres = measure(ThicknessMethod::kLayers);
    for (const float factor : {0.01f, 100.0f}) {
        set(scaled(scene, factor));
        Image other = measure(ThicknessMethod::kLayers);
        for (float& d : other.pixels) d = d > 0.0f ? d / factor : d;
        const ThicknessError difference = thickness_error(metres, other);
        EXPECT_LT(difference.relative, 1e-4) << factor;
        EXPECT_LT(difference.unmatched, 4u) << factor;  // pixels whose centre lies on an edge
    }
}

// Four surfaces on the way through the middle of two balls: with three, the second ball's entry has no exit.
TEST_F(Thickness, AnOddLayerOutCountsNothing) {
    Scene scene = waxen("shape:sphere,segments=64", sun({0, 0, -1}));
    add_copy(scene, moved({0.0f, 0.0f, -3.0f}));
    // In front of a plate that the light comes to behind both.
    add_copy(scene, moved({0.0f, 0.0f, -6.0f}));
    set(scene, 180.0f, 0.0f);
    const int middle = int(kSize / 2);
    for (const ThicknessMethod method : kLayered) {
        const auto through = [&](std::uint32_t layers) { return double(*measure(method, layers).at(middle, middle)); };
        // The point itself is the exit of whatever solid is still open.
        EXPECT_NEAR(through(8), 6.0, 0.02) << name_of(method);
        EXPECT_NEAR(through(2), 2.0, 0.02) << name_of(method);
        EXPECT_NEAR(through(4), 4.0, 0.02) << name_of(method);
        EXPECT_GT(measure_all(method, 4).cut_rays, 100u) << name_of(method);
        EXPECT_EQ(measure_all(method, 6).cut_rays, 0u) << name_of(method);
    }
}

// Light enters an open sheet and nothing says where it leaves: behind it gaps are gaps, and solids are solid.
TEST_F(Thickness, AnEntryWithoutAnExitSwallowsNoGap) {
    Scene scene = waxen("shape:sphere,segments=64", sun({0, 0, -1}));
    add_copy(scene, moved({0.0f, 0.0f, -3.0f}));
    add(scene, square(), wax(), glm::scale(moved({0.0f, 0.0f, 2.0f}), glm::vec3(4.0f)));
    set(scene, 180.0f, 0.0f);
    const int middle = int(kSize / 2);
    for (const ThicknessMethod method : kLayered)
        EXPECT_NEAR(double(*measure(method).at(middle, middle)), 4.0, 0.02) << name_of(method);
}

TEST_F(Thickness, OpaqueThingsCastShadows) {
    Scene scene = waxen("shape:sphere,segments=64", sun({0, 0, -1}));
    Material opaque;
    opaque.metallic = 0.0f;
    add(scene, square(), opaque, moved({1.0f, 0.0f, 3.0f}));
    set(scene, 180.0f, 0.0f);
    const Image truth = exact(), thickness = measure(ThicknessMethod::kLayers);
    int shadowed = 0, different = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        shadowed += truth.pixels[i] == kShadowed ? 1 : 0;
        different += (truth.pixels[i] == kShadowed) != (thickness.pixels[i] == kShadowed) ? 1 : 0;
    }
    EXPECT_GT(shadowed, 400);
    EXPECT_LT(different, shadowed / 50);
}

TEST_F(Thickness, PointAndSpotLights) {
    Scene scene = waxen("shape:torus", lamp({0.0f, 0.0f, 3.0f}));
    add_copy(scene, moved({0.4f, 0.2f, -1.2f}));
    const std::pair<const char*, Light> lights[] = {
        {"lamp in front", lamp({0.3f, 0.2f, 3.0f})},
        {"lamp in the ring", lamp({0.0f, 0.0f, 0.0f})},
        {"lamp between", lamp({0.9f, 1.1f, -0.5f})},
        {"spot", spot({0.0f, 0.5f, 3.0f}, {0.1f, -0.1f, -1.0f}, 0.25f)},
    };
    for (const auto& [name, light] : lights) {
        scene.lights.assign(1, light);
        set(scene);
        ASSERT_GT(shares(exact()).translucent, 100) << name;
        for (const ThicknessMethod method : kLayered) EXPECT_LT(error(method), 0.01) << name << ", " << name_of(method);
        const ThicknessError difference = thickness_error(exact(), measure(ThicknessMethod::kLayers));
        EXPECT_LT(double(difference.unmatched), 0.02 * double(difference.points)) << name;
    }
    EXPECT_EQ(measure_all(ThicknessMethod::kLayers).light_views, 1u);
    scene.lights.assign(1, lamp({0.0f, 0.0f, 0.0f}));
    set(scene);
    EXPECT_GT(measure_all(ThicknessMethod::kLayers).light_views, 3u);
}

TEST_F(Thickness, LayeredMethodsAgree) {
    set(waxen("shape:knot", sun({0.5f, -0.7f, -1.0f})));
    const Image layers = measure(ThicknessMethod::kLayers, 12);
    EXPECT_LT(error(ThicknessMethod::kLayers, 12), 0.01);
    for (const ThicknessMethod method : {ThicknessMethod::kDepthPeeling, ThicknessMethod::kDualDepthPeeling}) {
        // The compute rasteriser may decide otherwise about a texel whose centre lies on an edge.
        EXPECT_LT(thickness_error(layers, measure(method, 12)).relative, 1e-3) << name_of(method);
    }
    EXPECT_EQ(measure(ThicknessMethod::kDepthPeeling, 12).pixels,
              measure(ThicknessMethod::kDualDepthPeeling, 12).pixels);
    EXPECT_EQ(measure_all(ThicknessMethod::kDepthPeeling, 12).geometry_passes, 12u);
    EXPECT_EQ(measure_all(ThicknessMethod::kDualDepthPeeling, 12).geometry_passes, 7u);
    EXPECT_EQ(measure_all(ThicknessMethod::kLayers, 12).geometry_passes, 1u);
}

// The mean way out of a ball is 4/3 of its radius, whatever the light; a stretched ball is baked as it stands.
TEST_F(Thickness, LocalThickness) {
    Scene scene = waxen("shape:sphere,segments=32", sun({0, 0, -1}));
    for (const float stretch : {1.0f, 3.0f}) {
        scene.objects[0].world_from_object = glm::scale(glm::mat4(1.0f), glm::vec3(2.0f, 2.0f * stretch, 2.0f));
        set(scene, 180.0f, 0.0f);
        const Image thickness = measure(ThicknessMethod::kLocalThickness);
        const float middle = *thickness.at(int(kSize / 2), int(kSize / 2));
        if (stretch == 1.0f)
            EXPECT_NEAR(middle, 2.0f * 4.0f / 3.0f, 0.02f);
        else
            EXPECT_GT(middle, 2.0f * 4.0f / 3.0f + 0.2f);
        ASSERT_GT(shares(thickness).translucent, 500);
    }
    set(scene, 0.0f, 0.0f);
    const Image lit = measure(ThicknessMethod::kLocalThickness);
    EXPECT_EQ(*lit.at(int(kSize / 2), int(kSize / 2)), 0.0f);
}

TEST_F(Thickness, LargeMapsAndManyFragmentsAreRepeated) {
    Scene scene = waxen("shape:sphere,segments=16", sun({0, 0, -1}));
    for (int i = 1; i < 40; ++i) add_copy(scene, moved({0.0f, 0.0f, -0.01f * float(i)}));
    set(scene);
    EXPECT_LT(error(ThicknessMethod::kLayers, 80, 64), 0.05);
    EXPECT_LT(error(ThicknessMethod::kDualDepthPeeling, 80, 64), 0.05);
}

TEST_F(Thickness, BadRequests) {
    set(waxen("shape:sphere", sun({0, 0, -1})));
    const auto error_of = [&](ThicknessSettings settings, std::uint32_t light) {
        try {
            renderer().measure_thickness(
                {.width = 8, .height = 8, .settings = settings, .light = light, .progress = {}});
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(error_of({ThicknessMethod::kLayers, 0, 64}, 0), ::testing::HasSubstr("0 layers"));
    EXPECT_THAT(error_of({ThicknessMethod::kLayers, 4, 1}, 0), ::testing::HasSubstr("1 texels"));
    EXPECT_THAT(error_of({ThicknessMethod::kLayers, 4, 1u << 30}, 0), ::testing::HasSubstr("texels"));
    EXPECT_THAT(error_of({ThicknessMethod::kLayers, 4, 64}, 1), ::testing::HasSubstr("no light 1"));
    EXPECT_EQ(error_of({ThicknessMethod::kLayers, 4, 64}, 0), "");
    EXPECT_THROW(parse_thickness_method("rulers"), Error);
}

// What is added to the picture.
class TransmittedLight : public Thickness {
protected:
    Image draw(std::uint32_t size = kSize, ThicknessMethod method = ThicknessMethod::kLayers) {
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.thickness.method = method;
        return renderer().render(settings).radiance;
    }
};

// A sheet without thickness gives I0: the light's irradiance at that slant, times the colour over pi.
TEST_F(TransmittedLight, NothingIsLostWithoutThickness) {
    Material material = wax();
    material.diffuse_transmission_color = {0.8f, 0.5f, 0.25f};
    material.base_color = {0.4f, 0.6f, 0.2f, 1.0f};
    material.diffuse_transmission = 0.75f;
    Scene scene = scene_of(square(), material);
    const glm::vec3 way = glm::normalize(glm::vec3(0.2f, 0.3f, -1.0f)), intensity(3.0f, 2.0f, 1.0f);
    scene.lights.push_back(sun(way, intensity));
    for (const float azimuth : {180.0f, 0.0f}) {  // through it, and reflected
        set(scene, azimuth, 0.0f);
        const glm::vec3 share =
            azimuth == 0.0f ? 0.25f * glm::vec3(material.base_color) : 0.75f * material.diffuse_transmission_color;
        const glm::vec3 expected = share * intensity * (-way.z / kPi);
        EXPECT_LT(glm::distance(rgb(draw(), int(kSize / 2), int(kSize / 2)), expected), 2e-3f) << azimuth;
    }
}

TEST_F(TransmittedLight, DoublingTheExtinctionHalvesTheLength) {
    const auto through = [&](float distance, float thickness) {
        set(waxen(fmt::format("shape:slab,thickness={}", thickness), sun({0, 0, -1}),
                  wax({0.5f, 0.25f, 0.9f}, distance)),
            180.0f, 0.0f);
        return rgb(draw(), int(kSize / 2), int(kSize / 2));
    };
    const glm::vec3 whole = through(0.4f, 0.4f), half = through(0.2f, 0.2f);
    EXPECT_LT(glm::distance(whole, half), 1e-4f);
    const glm::vec3 expected = glm::vec3(0.5f, 0.25f, 0.9f) / kPi;
    EXPECT_LT(glm::distance(whole, expected), 1e-3f);
    const glm::vec3 twice = through(0.2f, 0.4f);
    EXPECT_LT(glm::distance(twice, expected * glm::vec3(0.5f, 0.25f, 0.9f)), 1e-3f);
}

// Lights add up, fall off with the square of the distance, and end at their range.
TEST_F(TransmittedLight, LampsFallOff) {
    Scene scene = scene_of(square(), wax());
    const auto seen = [&](std::vector<Light> lights) {
        scene.lights = std::move(lights);
        set(scene, 180.0f, 0.0f);
        return rgb(draw(63), 31, 31).g;
    };
    const float near = seen({lamp({0, 0, 2})}), far = seen({lamp({0, 0, 4})});
    EXPECT_NEAR(near, 1.0f / (4.0f * kPi), 1e-3f);
    EXPECT_NEAR(far, near / 4.0f, 1e-3f);
    EXPECT_NEAR(seen({lamp({0, 0, 2}), lamp({0, 0, 4})}), near + far, 1e-3f);
    EXPECT_NEAR(seen({spot({0, 0, 2}, {0, 0, -1}, 0.5f)}), near, 1e-3f);
    EXPECT_EQ(seen({spot({0, 0, 2}, {0, 1, 0}, 0.5f)}), 0.0f);
    Light ends = lamp({0, 0, 2});
    ends.range = 1.5f;
    EXPECT_EQ(seen({ends}), 0.0f);
}

TEST_F(TransmittedLight, GlassOpaqueAndWaxInOnePicture) {
    Scene scene = waxen("shape:sphere,segments=32", sun({0, 0, -1}));
    add(scene, scene.meshes[0], glass(), moved({2.2f, 0, 0}));
    Material opaque;
    add(scene, scene.meshes[0], opaque, moved({-2.2f, 0, 0}));
    set(scene, 160.0f, 10.0f);
    const Image with = draw();
    EXPECT_TRUE(all_finite(with));
    float brightest = 0.0f;
    for (const float value : with.pixels) brightest = std::max(brightest, value);
    EXPECT_GT(brightest, 0.01f);
    for (const ThicknessMethod method : kLayered) EXPECT_LT(rmse(with, draw(kSize, method)), 1e-3);
}

}  // namespace
}  // namespace pellucid::test
