#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <functional>

namespace pellucid {

/// Converts a pixel, RGB as in the image, into linear Rec.709 as a display shows it, 0..1.
using ShownColor = std::function<glm::vec3(glm::vec3)>;

/// Throws Error unless both images are RGB, not empty and of equal size, and pixels_per_degree is finite and at least
/// 1.
void check_flip_input(const Image& reference, const Image& test, double pixels_per_degree);

/// Raises `map` to the LDR-FLIP of the two displayed images: each pixel becomes the maximum of both. `map` has one
/// channel and the images' size. Symmetric in the images. Needs memory for the map and a few rows.
void raise_to_flip(Image& map, const Image& reference, const Image& test, const ShownColor& shown,
                   double pixels_per_degree);

}  // namespace pellucid
