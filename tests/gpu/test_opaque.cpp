// Opaque surfaces under the environment, against the path tracer.
#include "gpu/gpu_test.h"

#include <fmt/format.h>

#include <array>
#include <tuple>

namespace pellucid::test {
namespace {

constexpr int kSize = 48;

Material coated(glm::vec3 color, float metallic, float roughness) {
    Material material;
    material.base_color = glm::vec4(color, 1.0f);
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

/// The sky as a map, its sun brighter than a few texels can show smoothly.
Environment sky_map() {
    Environment sky;
    sky.kind = Environment::Kind::kSky;
    Environment environment;
    environment.kind = Environment::Kind::kMap;
    environment.map = Image(256, 128, 3);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 256; ++x) {
            const float longitude = ((float(x) + 0.5f) / 128.0f - 1.0f) * kPi, down = (float(y) + 0.5f) / 128.0f * kPi;
            const glm::vec3 seen = radiance(
                sky, {std::sin(down) * std::cos(longitude), std::cos(down), std::sin(down) * std::sin(longitude)});
            std::copy_n(&seen.x, 3, environment.map.at(x, y));
        }
    }
    return environment;
}

class OpaqueSurfaces : public RendererTest {
protected:
    void set(const Material& material, const Environment& environment, std::vector<Image> images = {}) {
        scene_ = load_scene("shape:sphere");
        scene_.image_names.resize(images.size(), "texture");
        scene_.images = std::move(images);
        scene_.materials[0] = material;
        renderer().set_scene(scene_);
        renderer().set_environment(environment);
        camera_ = framing_camera(scene_bounds(scene_), kSize, kSize, Camera{}.vertical_fov);
        renderer().set_camera(camera_);
    }
    Image draw(const char* technique, std::uint32_t samples) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.samples = samples;
        return renderer().render(settings).radiance;
    }
    /// Calls compare(drawn, true radiance, cosine to the viewer) for pixels on the ball.
    template <class Compare>
    void for_each_pixel(std::uint32_t path_samples, Compare compare) {
        const Image drawn = draw("wyman-2005", 16), truth = draw("path", path_samples);
        const Bounds bounds = scene_bounds(scene_);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const WorldRay ray = pixel_ray(camera_, kSize, kSize, x, y);
                const glm::dvec3 to_middle = glm::dvec3(bounds.center) - ray.origin;
                const double off = glm::length(glm::cross(ray.direction, to_middle)) / double(bounds.half_size.x);
                if (off < 0.96) compare(rgb(drawn, x, y), rgb(truth, x, y), std::sqrt(1.0 - off * off));
            }
        }
    }
    /// Mean absolute error over mean radiance, on the ball.
    double error(std::uint32_t path_samples) {
        double difference = 0.0, light = 0.0;
        for_each_pixel(path_samples, [&](glm::vec3 drawn, glm::vec3 truth, double) {
            difference += double(glm::dot(glm::abs(drawn - truth), glm::vec3(1.0f)));
            light += double(glm::dot(truth, glm::vec3(1.0f)));
        });
        return difference / light;
    }

private:
    Scene scene_;
    Camera camera_;
};

// All of the light that is lost, is lost between facets: the truth follows one reflection, too. The table of what they
// reflect is off by a few parts in 10^4; what the rest of a tolerance is for is the noise of 1024 paths per pixel.
TEST_F(OpaqueSurfaces, WhiteFurnace) {
    constexpr int kRings = 4;
    for (const float metallic : {0.0f, 1.0f}) {
        for (const float roughness : {0.0f, 0.1f, 0.35f, 0.7f, 1.0f}) {
            set(coated(glm::vec3(1.0f), metallic, roughness), uniform_environment());
            std::array<double, kRings> difference{}, pixels{};
            for_each_pixel(1024, [&](glm::vec3 drawn, glm::vec3 truth, double cos_theta) {
                const auto ring = std::size_t(std::min(int(kRings * cos_theta), kRings - 1));
                difference[ring] += double(drawn.g - truth.g);
                ++pixels[ring];
                EXPECT_LT(glm::distance(drawn, truth), 0.12f);
            });
            for (int ring = 1; ring < kRings; ++ring) {  // the outermost one is that of the silhouette
                EXPECT_NEAR(difference[std::size_t(ring)] / pixels[std::size_t(ring)], 0.0, 4e-3)
                    << "metallic " << metallic << ", roughness " << roughness << ", ring " << ring;
            }
        }
    }
}

// A lobe of one width and round stands for one that is wide along the plane of view and narrow across it, and nine
// harmonics for the irradiance. Under the few small lamps of the studio that shows more than under the sky.
TEST_F(OpaqueSurfaces, LookAsThePathTracerHasThem) {
    Environment studio;
    studio.kind = Environment::Kind::kStudio;
    const std::tuple<const char*, Environment, double> cases[] = {{"studio", studio, 0.12},
                                                                  {"sky map", sky_map(), 0.06}};
    for (const auto& [name, environment, tolerance] : cases) {
        for (const float metallic : {0.0f, 1.0f}) {
            for (const float roughness : {0.1f, 0.5f, 1.0f}) {
                set(coated({0.9f, 0.6f, 0.3f}, metallic, roughness), environment);
                const double seen = error(512);
                EXPECT_LT(seen, tolerance) << name << ", metallic " << metallic << ", roughness " << roughness;
                RecordProperty(fmt::format("{} {} {}", name, metallic, roughness), fmt::format("{:.4f}", seen));
            }
        }
    }
}

TEST_F(OpaqueSurfaces, TextureOfMetalAndRoughnessMultipliesTheFactors) {
    Material plain = coated({0.9f, 0.6f, 0.3f}, 0.8f, 0.4f);
    const Environment environment = sky_map();
    set(plain, environment);
    const Image drawn = draw("wyman-2005", 1), truth = draw("path", 4);
    plain.metallic = plain.roughness = 1.0f;
    plain.metallic_roughness_texture.image = 0;
    Image image(1, 1, 3);
    image.pixels = {0.0f, 0.4f, 0.8f};  // whole multiples of 1/255
    set(plain, environment, {image});
    const Image textured = draw("wyman-2005", 1), textured_truth = draw("path", 4);
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
        ASSERT_NEAR(textured.pixels[i], drawn.pixels[i], 1e-4f * (1.0f + drawn.pixels[i])) << i;
        ASSERT_NEAR(textured_truth.pixels[i], truth.pixels[i], 1e-4f * (1.0f + truth.pixels[i])) << i;
    }
}

}  // namespace
}  // namespace pellucid::test
