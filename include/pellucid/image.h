#pragma once

#include <pellucid/api.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// A rectangle of float pixels, rows from the top, channels interleaved.
/// Colours are scene-linear with Rec.709 primaries unless a function says otherwise.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;  ///< width * height * channels values

    Image() = default;
    Image(int w, int h, int c)
        : width(w), height(h), channels(c), pixels(std::size_t(w) * std::size_t(h) * std::size_t(c)) {}

    float* at(int x, int y) { return pixels.data() + offset(x, y); }
    const float* at(int x, int y) const { return pixels.data() + offset(x, y); }

private:
    std::size_t offset(int x, int y) const {
        return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
    }
};

/// Reads any format that OpenImageIO supports. 8 and 16 bit values map to 0..1 and are not decoded: an sRGB file stays
/// sRGB-encoded. Float values stay unchanged. Throws Error naming the file if it is missing, is not an image, or has
/// more than 2^28 pixels.
PELLUCID_API Image read_image(const std::filesystem::path& file);

/// Reads an image as read_image() does, from the bytes of an image file. Error messages use `name` as the file's name.
PELLUCID_API Image decode_image(const void* bytes, std::size_t size, const std::string& name);

/// Writes `image` in the format of the file's extension: `.exr` as 32-bit float (ZIP), `.png` as 8 bit. For `.png`,
/// values must be in 0..1 and already encoded for display. The file appears complete or not at all. Throws Error if it
/// cannot be written.
PELLUCID_API void write_image(const std::filesystem::path& file, const Image& image);

/// Writes an image with a name for every channel. EXR stores the names; the default is Y, or R, G, B, A.
PELLUCID_API void write_image(const std::filesystem::path& file, const Image& image,
                              const std::vector<std::string>& channel_names);

}  // namespace pellucid
