#include <pellucid/image.h>

#include "core/exr_colors.h"
#include "core/fail.h"
#include "core/file.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>

namespace pellucid {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;

/// Image library's message, shortened to its cause.
std::string cause_or(const std::string& message, const char* otherwise) {
    return message.empty() ? std::string(otherwise) : one_line(message);
}

OIIO::ImageSpec keep_alpha_as_stored() {
    OIIO::ImageSpec config;
    // PNG colours are not multiplied by alpha; by default OpenImageIO multiplies them in.
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

Image read_pixels(OIIO::ImageInput& input, const std::string& name) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1 || spec.deep)
        fail(name, "is not a flat two-dimensional image");
    if (std::int64_t(spec.width) * spec.height > kMaxPixels)
        fail(name, fmt::format("image of {} x {} pixels is larger than 2^28 pixels", spec.width, spec.height));
    Image image(spec.width, spec.height, spec.nchannels);
    if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        fail(name, "damaged image: " + cause_or(input.geterror(), "pixels cannot be read"));
    return image;
}

/// File extension that goes with the first bytes of an image; empty if unknown. Names inside glTF
/// files are often missing or wrong, and the image library chooses its reader by them.
std::string_view extension_of_content(const void* bytes, std::size_t size) {
    const std::string_view head(static_cast<const char*>(bytes), std::min<std::size_t>(size, 16));
    if (head.starts_with("\x89PNG")) return ".png";
    if (head.starts_with("\xff\xd8\xff")) return ".jpg";
    if (head.starts_with("\x76\x2f\x31\x01")) return ".exr";
    if (head.starts_with("#?")) return ".hdr";
    if (head.starts_with("GIF8")) return ".gif";
    if (head.starts_with("BM")) return ".bmp";
    if (head.starts_with("RIFF")) return ".webp";
    if (head.starts_with("DDS ")) return ".dds";
    if (head.size() >= 12 && head.substr(4, 7) == "ftypavi") return ".avif";
    return {};
}

std::vector<std::string> default_channel_names(int channels) {
    if (channels == 1) return {"Y"};
    if (channels == 2) return {"Y", "A"};
    std::vector<std::string> names = {"R", "G", "B", "A"};
    for (int i = 4; i < channels; ++i) names.push_back("channel" + std::to_string(i));
    names.resize(std::size_t(channels));
    return names;
}

std::vector<std::uint8_t> display_bytes(const Image& image) {
    std::vector<std::uint8_t> bytes(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), bytes.begin(), [](float value) {
        // Written so that NaN becomes 0.
        const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
        return static_cast<std::uint8_t>(clamped * 255.0f + 0.5f);
    });
    return bytes;
}

void write_pixels(const std::filesystem::path& file, const std::filesystem::path& temporary, const Image& image,
                  const OIIO::ImageSpec& spec, const void* pixels) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(temporary.string());
    if (!output) fail(file, "cannot write: " + cause_or(OIIO::geterror(), "no writer"));
    if (!output->open(temporary.string(), spec) || !output->write_image(spec.format, pixels) || !output->close())
        fail(file, fmt::format("cannot write {} x {} pixels: {}", image.width, image.height,
                               cause_or(output->geterror(), "unknown cause")));
}

}  // namespace

Image read_image(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) fail(file, "no such file");
    if (!std::filesystem::is_regular_file(file, error)) fail(file, "is not a regular file");
    const std::optional<glm::mat3> rec709_from_stored = rec709_from_exr(file, first_bytes(file));
    const OIIO::ImageSpec config = keep_alpha_as_stored();
    const auto input = OIIO::ImageInput::open(file.string(), &config);
    if (!input) fail(file, "is no readable image: " + cause_or(OIIO::geterror(), "unknown format"));
    Image image = read_pixels(*input, file.string());
    if (rec709_from_stored) convert_colors(image, *rec709_from_stored);
    return image;
}

Image decode_image(const void* bytes, std::size_t size, const std::string& name) {
    const std::string_view extension = extension_of_content(bytes, size);
    if (extension.empty()) fail(name, "is no image of a known format");
    const std::optional<glm::mat3> rec709_from_stored =
        rec709_from_exr(name, {static_cast<const std::byte*>(bytes), size});
    OIIO::Filesystem::IOMemReader memory(const_cast<void*>(bytes), size);
    OIIO::ImageSpec config = keep_alpha_as_stored();
    // With a configuration, open() ignores a reader that is passed as its own argument.
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open("image" + std::string(extension), &config);
    if (!input) fail(name, "is no readable image: " + cause_or(OIIO::geterror(), "unknown format"));
    Image image = read_pixels(*input, name);
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

    OIIO::ImageSpec spec(image.width, image.height, image.channels,
                         png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    spec.channelnames = channel_names;
    if (png) {
        spec.attribute("oiio:ColorSpace", "sRGB");
        spec.attribute("oiio:UnassociatedAlpha", 1);
    } else {
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the time of writing: no two runs would give one file
    }
    const std::vector<std::uint8_t> bytes = png ? display_bytes(image) : std::vector<std::uint8_t>();
    const void* pixels = png ? static_cast<const void*>(bytes.data()) : image.pixels.data();
    write_file_atomically(
        file, [&](const std::filesystem::path& temporary) { write_pixels(file, temporary, image, spec, pixels); });
}

}  // namespace pellucid
