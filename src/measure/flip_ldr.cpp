#include <pellucid/measure.h>

#include "measure/flip_map.h"

#include <cmath>

namespace pellucid {
namespace {

/// Inverse sRGB curve (IEC 61966-2-1). Clips to 0..1; NaN is 0.
float linear_from_srgb(float encoded) {
    if (!(encoded > 0.0f)) return 0.0f;
    if (encoded >= 1.0f) return 1.0f;
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

Image flip_ldr(const Image& reference, const Image& test, double pixels_per_degree) {
    check_flip_input(reference, test, pixels_per_degree);
    Image map(reference.width, reference.height, 1);
    const ShownColor shown = [](glm::vec3 rgb) {
        return glm::vec3(linear_from_srgb(rgb.x), linear_from_srgb(rgb.y), linear_from_srgb(rgb.z));
    };
    raise_to_flip(map, reference, test, shown, pixels_per_degree);
    return map;
}

}  // namespace pellucid
