#include "report/color_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Linear Rec.709 of an OKLab colour (Ottosson 2020).
glm::vec3 linear_from_oklab(glm::vec3 lab) {
    const glm::vec3 root(lab.x + 0.3963377774f * lab.y + 0.2158037573f * lab.z,
                         lab.x - 0.1055613458f * lab.y - 0.0638541728f * lab.z,
                         lab.x - 0.0894841775f * lab.y - 1.2914855480f * lab.z);
    const glm::vec3 lms = root * root * root;
    return {4.0767416621f * lms.x - 3.3077115913f * lms.y + 0.2309699292f * lms.z,
            -1.2684380046f * lms.x + 2.6097574011f * lms.y - 0.3413193965f * lms.z,
            -0.0041960863f * lms.x - 0.7034186147f * lms.y + 1.7076147010f * lms.z};
}

float srgb_encoded(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Colour with evenly increasing lightness and hue; chroma is limited to the sRGB gamut.
glm::vec3 scale_color(float share) {
    const float lightness = glm::mix(0.32f, 0.96f, share);
    const float hue = glm::radians(glm::mix(268.0f, 460.0f, share));
    const float chroma = std::min(0.17f, 0.085f + 0.55f * (1.0f - share) * (1.0f - share));
    const glm::vec3 linear = linear_from_oklab({lightness, chroma * std::cos(hue), chroma * std::sin(hue)});
    return {srgb_encoded(linear.r), srgb_encoded(linear.g), srgb_encoded(linear.b)};
}

template <typename ColorOf>
Image colored(const Image& map, ColorOf&& color_of) {
    Image image(map.width, map.height, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const glm::vec3 color = color_of(map.pixels[i]);
        std::copy_n(&color.x, 3, &image.pixels[3 * i]);
    }
    return image;
}

}  // namespace

ColorScale::ColorScale() {
    for (std::size_t i = 0; i < colors_.size(); ++i) colors_[i] = scale_color(float(i) / float(colors_.size() - 1));
}

glm::vec3 ColorScale::at(float share) const {
    const float clamped = share < 1.0f ? std::max(share, 0.0f) : 1.0f;  // NaN becomes 1
    return colors_[std::size_t(clamped * float(colors_.size() - 1) + 0.5f)];
}

float error_share(float error_deg) {
    const double shown = std::max(double(error_deg), kLeastErrorDeg);
    return float(std::log(shown / kLeastErrorDeg) / std::log(kGreatestErrorDeg / kLeastErrorDeg));
}

Image color_errors(const Image& error_deg) {
    const ColorScale scale;
    return colored(error_deg,
                   [&](float degrees) { return degrees < 0.0f ? kUncoveredColor : scale.at(error_share(degrees)); });
}

Image color_flip(const Image& flip) {
    const ColorScale scale;
    return colored(flip, [&](float value) { return scale.at(value); });
}

std::string hex_color(glm::vec3 color) {
    const glm::ivec3 bytes(glm::round(glm::clamp(color, 0.0f, 1.0f) * 255.0f));
    return fmt::format("#{:02x}{:02x}{:02x}", bytes.r, bytes.g, bytes.b);
}

}  // namespace pellucid
