#pragma once

#include <pellucid/image.h>

#include <string>

namespace pellucid::cli {

class DatasetRandom;

/// noise, checker and stripes are backgrounds that are made.
bool is_pattern(const std::string& name);
/// RGB, sRGB-encoded, 0..1, of random colours and sizes.
Image make_pattern(const std::string& name, DatasetRandom& random);
/// First three channels of an image file, or grey as all three. Throws Error naming the file.
Image read_background(const std::string& file);

}  // namespace pellucid::cli
