#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <array>
#include <string>

namespace pellucid {

/// Colours for 0..1, from dark blue over magenta to pale yellow, sRGB-encoded. Lightness rises evenly in OKLab
/// (Ottosson, "A perceptual color space for image processing", 2020). Larger values thus look brighter without colour
/// vision and in grey print too; the hue adds contrast for other readers.
class ColorScale {
public:
    ColorScale();

    /// Colour of `share`, clamped to 0..1; NaN counts as 1.
    glm::vec3 at(float share) const;

private:
    std::array<glm::vec3, 256> colors_;
};

/// Ends of the logarithmic scale of angular errors, degrees.
inline constexpr double kLeastErrorDeg = 0.01;
inline constexpr double kGreatestErrorDeg = 180.0;

/// Colour without a value: neutral, and darker than the whole scale.
inline constexpr glm::vec3 kUncoveredColor{0.11f};

/// Position of an angular error on the scale, 0..1.
float error_share(float error_deg);

/// Colours a map of one channel for display, RGB. color_errors(): degrees, negative if not covered; color_flip():
/// 0..1.
Image color_errors(const Image& error_deg);
Image color_flip(const Image& flip);

/// `#rrggbb` of an sRGB-encoded colour, 0..1.
std::string hex_color(glm::vec3 color);

}  // namespace pellucid
