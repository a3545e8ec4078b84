#pragma once

#include <pellucid/image.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Pixels of the largest image that is read, or made of others.
inline constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;

/// Image files, read and written by OpenImageIO in a shared library of its own. Some 240 libraries stand behind
/// OpenImageIO, which take 0.15 s to load, so the module is loaded with the first image.
/// Its functions return the cause of a failure, or "". They throw nothing of ours: both sides have their own Error.
struct ImageModule {
    std::string (*read)(const std::string& file, Image& image);
    std::string (*decode)(const void* bytes, std::size_t size, Image& image);
    /// As PNG of 8 bits or as EXR of 32-bit float.
    std::string (*write)(const std::string& file, bool png, const Image& image,
                         const std::vector<std::string>& channel_names);
    std::string (*encode_png)(const Image& image, std::vector<std::byte>& bytes);
};

/// Name by which the module exports its `extern "C" const ImageModule`.
inline constexpr const char* kImageModuleSymbol = "pellucid_image_module";

/// Loads the module on the first call. Throws Error if its file is missing.
const ImageModule& image_module();

}  // namespace pellucid
