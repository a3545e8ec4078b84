#include <pellucid/image.h>

#include "core/exr_colors.h"
#include "core/fail.h"
#include "core/file.h"
#include "core/image_module.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <fmt/format.h>

namespace pellucid {
namespace {

/// Fails in one line, whatever the image library says.
void check(const std::filesystem::path& file, const std::string& failure) {
    if (!failure.empty()) fail(file, one_line(failure));
}

std::vector<std::string> default_channel_names(int channels) {
    if (channels == 1) return {"Y"};
    if (channels == 2) return {"Y", "A"};
    std::vector<std::string> names = {"R", "G", "B", "A"};
    for (int i = 4; i < channels; ++i) names.push_back("channel" + std::to_string(i));
    names.resize(std::size_t(channels));
    return names;
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) fail(file, "no such file");
    if (!std::filesystem::is_regular_file(file, error)) fail(file, "is not a regular file");
    const std::optional<glm::mat3> rec709_from_stored = rec709_from_exr(file, first_bytes(file, kExrHead));
    Image image;
    check(file, image_module().read(file.string(), image));
    if (rec709_from_stored) convert_colors(image, *rec709_from_stored);
    return image;
}

Image decode_image(const void* bytes, std::size_t size, const std::string& name) {
    const std::optional<glm::mat3> rec709_from_stored =
        rec709_from_exr(name, {static_cast<const std::byte*>(bytes), size});
    Image image;
    check(name, image_module().decode(bytes, size, image));
    if (rec709_from_stored) convert_colors(image, *rec709_from_stored);
    return image;
}

void write_image(const std::filesystem::path& file, const Image& image) {
    write_image(file, image, default_channel_names(image.channels));
}

void write_image(const std::filesystem::path& file, const Image& image, const std::vector<std::string>& channel_names) {
    const std::string extension = lower_extension(file);
    const bool png = extension == ".png";
    if (!png && extension != ".exr")
        fail(file, fmt::format("cannot write images as \"{}\" (known: .exr, .png)", extension));
    if (image.width <= 0 || image.height <= 0 || image.channels <= 0)
        fail(file, "cannot write an image without pixels");
    if (channel_names.size() != std::size_t(image.channels))
        fail(file, fmt::format("{} channel names for an image of {} channels", channel_names.size(), image.channels));
    if (png && image.channels > 4) fail(file, fmt::format("a PNG file has at most 4 channels, not {}", image.channels));
    write_file_atomically(file, [&](const std::filesystem::path& temporary) {
        check(file, image_module().write(temporary.string(), png, image, channel_names));
    });
}

}  // namespace pellucid
