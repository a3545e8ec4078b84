#pragma once

#include <pellucid/image.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace pellucid {

/// Linear Rec.709 (D65) from the colours of an OpenEXR file, by the chromaticities in its header (`head`: the first bytes
/// of the file). None where they are Rec.709's, or not given, or where the bytes are of no OpenEXR file. White stays white,
/// by Bradford's adaptation (Lam 1985).
/// Throws Error naming `file` for colours that are stored as luminance and chroma, which are not read.
std::optional<glm::mat3> rec709_from_exr(const std::filesystem::path& file, std::span<const std::byte> head);

/// The first bytes of a file: what rec709_from_exr() needs of it.
std::vector<std::byte> first_bytes(const std::filesystem::path& file);

/// Converts the first three channels of each pixel; what lies outside of Rec.709 is clipped at 0.
void convert_colors(Image& image, const glm::mat3& rec709_from_rgb);

}  // namespace pellucid
