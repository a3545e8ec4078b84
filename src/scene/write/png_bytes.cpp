#include "scene/write/png_bytes.h"

#include "core/fail.h"
#include "core/file.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <system_error>

namespace pellucid {

// The image library writes files only.
std::vector<std::byte> png_bytes(const Image& image) {
    std::vector<std::byte> bytes;
    std::string folder = (std::filesystem::temp_directory_path() / "pellucid-XXXXXX").string();
    if (!mkdtemp(folder.data())) fail(folder, "cannot make a temporary folder");
    const std::filesystem::path file = std::filesystem::path(folder) / "image.png";
    std::error_code ignored;
    try {
        write_image(file, image);
        bytes = read_file(file);
    } catch (...) {
        std::filesystem::remove_all(folder, ignored);
        throw;
    }
    std::filesystem::remove_all(folder, ignored);
    return bytes;
}

bool is_exact_as_png(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) {
        return value >= 0.0f && value <= 1.0f && std::abs(value * 255.0f - std::round(value * 255.0f)) < 1e-3f;
    });
}

}  // namespace pellucid
