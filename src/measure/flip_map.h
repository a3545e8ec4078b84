#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <functional>

namespace pellucid {

/// Turns a pixel, RGB as in the image, into linear Rec.709 as a display shows it, 0..1.
using ShownColor = std::function<glm::vec3(glm::vec3)>;

/// Throws Error unless both are RGB, have pixels, and are of one size, and pixels_per_degree is a finite number from 1.
void check_flip_input(const Image& reference, const Image& test, double pixels_per_degree);

/// LDR-FLIP of the two pictures as they are shown; `map`, of one channel and their size, becomes the greater of what it
/// was and that. Symmetric in the two. Needs memory for the map and a few rows.
void raise_to_flip(Image& map, const Image& reference, const Image& test, const ShownColor& shown,
                   double pixels_per_degree);

}  // namespace pellucid
