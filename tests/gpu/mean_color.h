#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <cstddef>

namespace pellucid::test {

/// Over the pixels of a picture of three channels.
inline glm::dvec3 mean_color(const Image& image) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) sum[int(i % 3)] += double(image.pixels[i]);
    return 3.0 / double(image.pixels.size()) * sum;
}

}  // namespace pellucid::test
