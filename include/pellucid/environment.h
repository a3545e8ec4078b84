#pragma once

#include <pellucid/api.h>
#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string>

namespace pellucid {

/// Light that arrives from infinitely far away.
///
/// Directions without rotation, +Y up: (x, y, z) lies in the equirectangular map at `u = 1/2 + atan2(z, x) / 2 pi`, `v
/// = acos(y) / pi` from the top row. +X is the image centre, -Z is at u = 1/4.
struct Environment {
    /// kMap reads `map`. The other kinds are formulas, evaluated exactly for every direction.
    enum class Kind : std::uint32_t { kMap, kStudio, kChecker, kSky, kUniform };

    Kind kind = Kind::kStudio;
    Image map;                         ///< kMap: 3 channels, linear radiance, finite and >= 0
    glm::vec3 uniform_radiance{1.0f};  ///< kUniform: radiance of every direction
    /// Radians, finite: a right-handed turn about +Y. After a quarter turn light from +X arrives from -Z.
    float rotation = 0.0f;
    float intensity = 1.0f;  ///< factor of the radiance, finite and >= 0
};

/// Environment by name: `studio`, `checker`, `sky`, `uniform` (radiance 1, the furnace test), or an equirectangular
/// `.hdr` / `.exr` file. Throws Error for a missing or unreadable file, and for an unknown name, listing the known
/// names. Negative, infinite and NaN texels become 0; `warning` reports their count.
PELLUCID_API Environment load_environment(const std::string& name_or_file, std::string* warning = nullptr);

/// Radiance from `direction` (unit, world, pointing away from the scene). Maps are sampled bilinearly,
/// wrapping in u and clamped in v.
PELLUCID_API glm::vec3 radiance(const Environment& environment, glm::vec3 direction);

/// Irradiance of the environment in nine spherical-harmonics coefficients, already convolved with
/// the clamped cosine: `E(n) = sum c[i] Y_i(n)`, order l = 0, 1, 2 with m ascending
/// (Ramamoorthi & Hanrahan 2001, section 3).
PELLUCID_API std::array<glm::vec3, 9> irradiance_coefficients(const Environment& environment);

}  // namespace pellucid
