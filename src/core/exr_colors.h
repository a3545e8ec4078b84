#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace pellucid {

inline constexpr std::size_t kExrHead = std::size_t(1) << 16;

/// Linear Rec.709 (D65) from the colours of an OpenEXR file, by the chromaticities in its header (`head`: the first
/// kExrHead bytes of the file). None where they are Rec.709's, or not given, or where the bytes are of no OpenEXR file. White stays white,
/// by Bradford's adaptation (Lam 1985).
/// Throws Error naming `file` for colours that are stored as luminance and chroma, which are not read.
std::optional<glm::mat3> rec709_from_exr(const std::filesystem::path& file, std::span<const std::byte> head);

/// Converts the first three channels of each pixel; what lies outside of Rec.709 is clipped at 0.
void convert_colors(Image& image, const glm::mat3& rec709_from_rgb);

}  // namespace pellucid
