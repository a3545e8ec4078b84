#include <pellucid/image.h>

#include "core/byte_stream.h"
#include "core/exr_colors.h"
#include "core/fail.h"
#include "core/file.h"
#include "core/image_module.h"
#include "core/read_apart.h"

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

/// Reads `file` if `bytes` is null.
Image read_by_module(const std::filesystem::path& file, const std::span<const std::byte>* bytes, MemoryBudget& memory) {
    ByteWriter request;
    request.value(memory.left());
    request.value(bytes != nullptr);
    request.text(file.string());
    if (bytes) request.values(*bytes);
    const std::vector<std::byte> result =
        read_apart(ApartKind::kImage, read_image_here, request.take(), memory.left(), file);
    ByteReader reader(result);
    const std::string failure = reader.text();
    Image image;
    image.width = reader.value<int>();
    image.height = reader.value<int>();
    image.channels = reader.value<int>();
    // The pixels of an image that is too large for the memory are not there.
    const std::uint64_t values =
        std::uint64_t(image.width) * std::uint64_t(image.height) * std::uint64_t(image.channels);
    memory.take(values, sizeof(float));
    check(file, failure);
    image.pixels = reader.values<float>();
    if (image.pixels.size() != values) fail(file, "is a damaged image");
    return image;
}

}  // namespace

std::vector<std::byte> read_image_here(std::span<const std::byte> request) {
    ByteReader reader(request);
    const auto most_bytes = reader.value<std::uint64_t>();
    const bool in_memory = reader.value<bool>();
    const std::string name = reader.text();
    Image image;
    std::string failure;
    if (in_memory) {
        const std::vector<std::byte> bytes = reader.values<std::byte>();
        failure = image_module().decode(bytes.data(), bytes.size(), most_bytes, image);
    } else {
        failure = image_module().read(name, most_bytes, image);
    }
    ByteWriter result;
    result.text(failure);
    for (const int number : {image.width, image.height, image.channels}) result.value(number);
    result.values(image.pixels);
    return result.take();
}

Image read_scene_image(const std::filesystem::path& file, MemoryBudget& memory) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) fail(file, "no such file");
    if (!std::filesystem::is_regular_file(file, error)) fail(file, "is not a regular file");
    const std::optional<glm::mat3> rec709_from_stored = rec709_from_exr(file, first_bytes(file, kExrHead));
    Image image = read_by_module(file, nullptr, memory);
    if (rec709_from_stored) convert_colors(image, *rec709_from_stored);
    return image;
}

Image decode_scene_image(std::span<const std::byte> bytes, const std::string& name, MemoryBudget& memory) {
    const std::optional<glm::mat3> rec709_from_stored = rec709_from_exr(name, bytes);
    Image image = read_by_module(name, &bytes, memory);
    if (rec709_from_stored) convert_colors(image, *rec709_from_stored);
    return image;
}

Image read_image(const std::filesystem::path& file) {
    MemoryBudget memory(file);
    return read_scene_image(file, memory);
}

Image decode_image(const void* bytes, std::size_t size, const std::string& name) {
    MemoryBudget memory(name);
    return decode_scene_image({static_cast<const std::byte*>(bytes), size}, name, memory);
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
