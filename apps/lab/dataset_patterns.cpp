#include "lab/dataset_patterns.h"

#include "lab/dataset_scene.h"

#include <cmath>

namespace pellucid::cli {
namespace {

constexpr int kSide = 512;  // texels

glm::vec3 random_color(DatasetRandom& random) {
    const double r = random.uniform(), g = random.uniform(), b = random.uniform();
    return glm::vec3(r, g, b);
}

template <class Color>
Image image_of(Color color) {
    Image image(kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const glm::vec3 texel = color(x, y);
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = texel[c];
        }
    return image;
}

Image make_checker(DatasetRandom& random) {
    const glm::vec3 a = random_color(random), b = random_color(random);
    const int cell = random.whole_within({12, 64});
    return image_of([&](int x, int y) { return (x / cell + y / cell) % 2 == 0 ? a : b; });
}

Image make_stripes(DatasetRandom& random) {
    const glm::vec3 a = random_color(random), b = random_color(random);
    const double angle = random.within({0.0, 3.14159}), width = random.within({8.0, 48.0});
    const double c = std::cos(angle), s = std::sin(angle);
    return image_of(
        [&](int x, int y) { return glm::mix(a, b, float(0.5 + 0.5 * std::sin(3.14159 * (c * x + s * y) / width))); });
}

/// Value noise: colours on a grid, interpolated smoothly, in four octaves (Perlin 1985).
Image make_noise(DatasetRandom& random) {
    Image sum(kSide, kSide, 3);
    float weight = 0.5f;
    for (int cells = random.whole_within({3, 8}); cells < kSide / 4; cells *= 3, weight *= 0.6f) {
        std::vector<glm::vec3> grid;
        for (int i = 0; i < (cells + 1) * (cells + 1); ++i) grid.push_back(random_color(random));
        const auto smooth = [](float t) { return t * t * (3.0f - 2.0f * t); };
        const Image octave = image_of([&](int x, int y) {
            const glm::vec2 at = glm::vec2(x, y) * (float(cells) / float(kSide));
            const int left = int(at.x), top = int(at.y);
            const float u = smooth(at.x - float(left)), v = smooth(at.y - float(top));
            const auto corner = [&](int dx, int dy) { return grid[std::size_t((top + dy) * (cells + 1) + left + dx)]; };
            return glm::mix(glm::mix(corner(0, 0), corner(1, 0), u), glm::mix(corner(0, 1), corner(1, 1), u), v);
        });
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += weight * octave.pixels[i];
    }
    for (float& value : sum.pixels) value = std::min(value, 1.0f);
    return sum;
}

}  // namespace

bool is_pattern(const std::string& name) { return name == "noise" || name == "checker" || name == "stripes"; }

Image make_pattern(const std::string& name, DatasetRandom& random) {
    if (name == "checker") return make_checker(random);
    return name == "stripes" ? make_stripes(random) : make_noise(random);
}

Image read_background(const std::string& file) {
    const Image image = read_image(file);
    Image rgb(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) rgb.at(x, y)[c] = image.at(x, y)[image.channels < 3 ? 0 : c];
    return rgb;
}

}  // namespace pellucid::cli
