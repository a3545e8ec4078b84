// The transfer function of sRGB (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace pellucid {

/// Clips to 0..1; NaN is 0.
inline float linear_from_srgb(float encoded) {
    if (!(encoded > 0.0f)) return 0.0f;
    if (encoded >= 1.0f) return 1.0f;
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Of 0..1.
inline float srgb_from_linear(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

}  // namespace pellucid
