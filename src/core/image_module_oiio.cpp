// The module of image files: see image_module.h.
#include "core/image_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {
namespace {

std::string cause_or(const std::string& message, const char* otherwise) {
    return message.empty() ? otherwise : message;
}

OIIO::ImageSpec keep_alpha_as_stored() {
    OIIO::ImageSpec config;
    // PNG colours are not multiplied by alpha; by default OpenImageIO multiplies them in.
    config.attribute("oiio:UnassociatedAlpha", 1);
    return config;
}

std::string read_pixels(OIIO::ImageInput& input, std::uint64_t most_bytes, Image& image) {
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1 || spec.deep)
        return "is not a flat two-dimensional image";
    if (std::int64_t(spec.width) * spec.height > kMaxPixels)
        return fmt::format("image of {} x {} pixels is larger than 2^28 pixels", spec.width, spec.height);
    if (std::uint64_t(spec.width) * std::uint64_t(spec.height) >
        most_bytes / sizeof(float) / std::uint64_t(spec.nchannels)) {
        image.width = spec.width, image.height = spec.height, image.channels = spec.nchannels;
        return fmt::format("image of {} x {} pixels with {} channels does not fit into memory", spec.width, spec.height,
                           spec.nchannels);
    }
    image = Image(spec.width, spec.height, spec.nchannels);
    if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.pixels.data()))
        return "damaged image: " + cause_or(input.geterror(), "pixels cannot be read");
    return {};
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

std::vector<std::uint8_t> display_bytes(const Image& image) {
    std::vector<std::uint8_t> bytes(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), bytes.begin(), [](float value) {
        // Written so that NaN becomes 0.
        const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;
        return static_cast<std::uint8_t>(clamped * 255.0f + 0.5f);
    });
    return bytes;
}

std::string read(const std::string& file, std::uint64_t most_bytes, Image& image) {
    const OIIO::ImageSpec config = keep_alpha_as_stored();
    const auto input = OIIO::ImageInput::open(file, &config);
    if (!input) return "is no readable image: " + cause_or(OIIO::geterror(), "unknown format");
    return read_pixels(*input, most_bytes, image);
}

std::string decode(const void* bytes, std::size_t size, std::uint64_t most_bytes, Image& image) {
    const std::string_view extension = extension_of_content(bytes, size);
    if (extension.empty()) return "is no image of a known format";
    OIIO::Filesystem::IOMemReader memory(const_cast<void*>(bytes), size);
    OIIO::ImageSpec config = keep_alpha_as_stored();
    // With a configuration, open() ignores a reader that is passed as its own argument.
    void* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open("image" + std::string(extension), &config);
    if (!input) return "is no readable image: " + cause_or(OIIO::geterror(), "unknown format");
    return read_pixels(*input, most_bytes, image);
}

/// `memory`, if any, gets the bytes, and `file` only says what they are.
std::string write_to(const std::string& file, OIIO::Filesystem::IOProxy* memory, bool png, const Image& image,
                     const std::vector<std::string>& channel_names) {
    OIIO::ImageSpec spec(image.width, image.height, image.channels,
                         png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    if (!channel_names.empty()) spec.channelnames = channel_names;
    if (png) {
        spec.attribute("oiio:ColorSpace", "sRGB");
        spec.attribute("oiio:UnassociatedAlpha", 1);
    } else {
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the time of writing: no two runs would give one file
    }
    const std::vector<std::uint8_t> bytes = png ? display_bytes(image) : std::vector<std::uint8_t>();
    const void* pixels = png ? static_cast<const void*>(bytes.data()) : image.pixels.data();
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(file);
    if (!output) return "cannot write: " + cause_or(OIIO::geterror(), "no writer");
    if (memory) output->set_ioproxy(memory);
    if (!output->open(file, spec) || !output->write_image(spec.format, pixels) || !output->close())
        return fmt::format("cannot write {} x {} pixels: {}", image.width, image.height,
                           cause_or(output->geterror(), "unknown cause"));
    return {};
}

std::string write(const std::string& file, bool png, const Image& image,
                  const std::vector<std::string>& channel_names) {
    if (!png) return write_to(file, nullptr, png, image, channel_names);
    // OpenImageIO does not report that a PNG file could not be written to its end, as on a full disk.
    OIIO::Filesystem::IOVecOutput memory;
    if (std::string cause = write_to("image.png", &memory, png, image, channel_names); !cause.empty()) return cause;
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(memory.buffer().data()), std::streamsize(memory.buffer().size()));
    stream.close();
    return stream ? "" : fmt::format("cannot write: {}", std::strerror(errno));
}

std::string encode_png(const Image& image, std::vector<std::byte>& bytes) {
    OIIO::Filesystem::IOVecOutput memory;
    std::string cause = write_to("image.png", &memory, true, image, {});
    const std::span<const std::byte> encoded = std::as_bytes(std::span(memory.buffer()));
    bytes.assign(encoded.begin(), encoded.end());
    return cause;
}

}  // namespace
}  // namespace pellucid

extern "C" [[gnu::visibility("default")]] const pellucid::ImageModule pellucid_image_module{
    &pellucid::read, &pellucid::decode, &pellucid::write, &pellucid::encode_png};
