#pragma once

#include <pellucid/image.h>

#include <cstddef>
#include <vector>

namespace pellucid {

/// A PNG file of an image of 1 to 4 channels.
std::vector<std::byte> png_bytes(const Image& image);
/// All values are multiples of 1/255 within 0..1.
bool is_exact_as_png(const Image& image);

}  // namespace pellucid
