#include "scene/write/png_bytes.h"

#include "core/image_module.h"

#include <pellucid/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace pellucid {

std::vector<std::byte> png_bytes(const Image& image) {
    std::vector<std::byte> bytes;
    if (const std::string cause = image_module().encode_png(image, bytes); !cause.empty()) throw Error(cause);
    return bytes;
}

bool is_exact_as_png(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) {
        return value >= 0.0f && value <= 1.0f && std::abs(value * 255.0f - std::round(value * 255.0f)) < 1e-3f;
    });
}

}  // namespace pellucid
