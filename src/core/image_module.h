#pragma once

#include "core/memory_budget.h"

#include <pellucid/image.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace pellucid {

/// Pixels of the largest image that is read, or made of others.
inline constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;

/// Image files, read and written by OpenImageIO in a shared library of its own. Some 240 libraries stand behind
/// OpenImageIO, which take 0.15 s to load, so the module is loaded with the first image.
/// Its functions return the cause of a failure, or "". They throw nothing of ours: both sides have their own Error.
struct ImageModule {
    /// Of an image whose pixels take more than `most_bytes`, only the size is read.
    std::string (*read)(const std::string& file, std::uint64_t most_bytes, Image& image);
    std::string (*decode)(const void* bytes, std::size_t size, std::uint64_t most_bytes, Image& image);
    /// As PNG of 8 bits or as EXR of 32-bit float.
    std::string (*write)(const std::string& file, bool png, const Image& image,
                         const std::vector<std::string>& channel_names);
    std::string (*encode_png)(const Image& image, std::vector<std::byte>& bytes);
};

/// Name by which the module exports its `extern "C" const ImageModule`.
inline constexpr const char* kImageModuleSymbol = "pellucid_image_module";

/// Loads the module. Its absence shows with the first image.
void load_image_module();

/// The reader of images, for read_apart().
std::vector<std::byte> read_image_here(std::span<const std::byte> request);

/// read_image() and decode_image() of what a scene uses. Throw Error, also if `memory` does not suffice.
Image read_scene_image(const std::filesystem::path& file, MemoryBudget& memory);
Image decode_scene_image(std::span<const std::byte> bytes, const std::string& name, MemoryBudget& memory);

/// Loads the module on the first call. Throws Error if its file is missing.
const ImageModule& image_module();

}  // namespace pellucid
