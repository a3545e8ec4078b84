// Header of an OpenEXR file ("OpenEXR File Layout", Academy Software Foundation).
#include "core/exr_colors.h"

#include "core/fail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace pellucid {
namespace {

/// x and y of red, green, blue and white.
using Chromaticities = std::array<float, 8>;
constexpr Chromaticities kRec709 = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

struct ExrHeader {
    std::optional<Chromaticities> chromaticities;
    bool luminance_chroma = false;
};

/// Up to the next zero, which is passed.
std::string_view take_name(std::string_view& bytes) {
    const std::size_t end = std::min(bytes.find('\0'), bytes.size());
    const std::string_view name = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    return name;
}

bool has_chroma(std::string_view channels) {
    constexpr std::size_t kAfterName = 16;  // bytes: type, linearity, sampling
    for (std::string_view name = take_name(channels); !name.empty(); name = take_name(channels)) {
        name.remove_prefix(name.rfind('.') == name.npos ? 0 : name.rfind('.') + 1);  // of a layer
        if (name == "RY" || name == "BY") return true;
        channels.remove_prefix(std::min(kAfterName, channels.size()));
    }
    return false;
}

ExrHeader read_header(std::string_view bytes) {
    ExrHeader header;
    if (!bytes.starts_with("\x76\x2f\x31\x01") || bytes.size() < 8) return header;
    bytes.remove_prefix(8);  // magic number and version
    for (std::string_view name = take_name(bytes); !name.empty(); name = take_name(bytes)) {
        const std::string_view type = take_name(bytes);
        std::int32_t size = 0;
        if (bytes.size() < sizeof size) return header;
        std::memcpy(&size, bytes.data(), sizeof size);
        bytes.remove_prefix(sizeof size);
        if (size < 0 || std::size_t(size) > bytes.size()) return header;
        const std::string_view value = bytes.substr(0, std::size_t(size));
        bytes.remove_prefix(value.size());
        if (name == "channels" && type == "chlist") header.luminance_chroma = has_chroma(value);
        if (name != "chromaticities" || value.size() != sizeof(Chromaticities)) continue;
        header.chromaticities.emplace();
        std::memcpy(header.chromaticities->data(), value.data(), value.size());
    }
    return header;
}

glm::dvec3 xyz_of(float x, float y) { return glm::dvec3(x, y, 1.0f - x - y) / double(y); }

/// Columns as bright as together they make the white.
glm::dmat3 xyz_from_rgb(const Chromaticities& c) {
    const glm::dmat3 primaries(xyz_of(c[0], c[1]), xyz_of(c[2], c[3]), xyz_of(c[4], c[5]));
    const glm::dvec3 scale = glm::inverse(primaries) * xyz_of(c[6], c[7]);
    return glm::dmat3(primaries[0] * scale.x, primaries[1] * scale.y, primaries[2] * scale.z);
}

glm::dmat3 adaptation(const glm::dvec3& from_white, const glm::dvec3& to_white) {
    const glm::dmat3 cones =
        glm::transpose(glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
    const glm::dvec3 gain = (cones * to_white) / (cones * from_white);
    return glm::inverse(cones) * glm::dmat3(gain.x, 0, 0, 0, gain.y, 0, 0, 0, gain.z) * cones;
}

bool same(const Chromaticities& a, const Chromaticities& b) {
    return std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) { return std::abs(x - y) < 1e-3f; });
}

}  // namespace

std::optional<glm::mat3> rec709_from_exr(const std::filesystem::path& file, std::span<const std::byte> head) {
    const ExrHeader header = read_header({reinterpret_cast<const char*>(head.data()), head.size()});
    if (header.luminance_chroma)
        fail(file, "stores luminance and chroma (channels Y, RY, BY), which are not read; save it with R, G and B");
    if (!header.chromaticities || same(*header.chromaticities, kRec709)) return std::nullopt;
    const Chromaticities& c = *header.chromaticities;
    const glm::dmat3 result = glm::inverse(xyz_from_rgb(kRec709)) *
                              adaptation(xyz_of(c[6], c[7]), xyz_of(kRec709[6], kRec709[7])) * xyz_from_rgb(c);
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) sum += glm::dot(glm::abs(result[i]), glm::dvec3(1.0));
    // Primaries in one line, or none: no colours could be told by them.
    if (!(sum < 100.0)) fail(file, "the chromaticities in its header are no colours; remove them or save it anew");
    return glm::mat3(result);
}

void convert_colors(Image& image, const glm::mat3& rec709_from_rgb) {
    if (image.channels < 3) return;
    const std::size_t channels = std::size_t(image.channels);
    for (std::size_t i = 0; i + channels <= image.pixels.size(); i += channels) {
        float* const p = &image.pixels[i];
        const glm::vec3 before(p[0], p[1], p[2]);
        const glm::vec3 after = rec709_from_rgb * before;
        // What was negative or no number stays, for others to complain about.
        for (int k = 0; k < 3; ++k) p[k] = before[k] >= 0.0f ? std::max(after[k], 0.0f) : before[k];
    }
}

}  // namespace pellucid
