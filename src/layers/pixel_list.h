#pragma once

#include "gpu/frame.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pellucid {

/// Lists the pixels whose value in layer 0 of `marks` (R32UI) is not `empty`, for Recorder::compute_indirect(). Only
/// rows `first_row` to `row_end` - 1 are listed. The order is undefined. Shaders read the list through pixel_list.glsl,
/// as "PixelList". `wanted`: lists only pixels that want this frame's sample.
const Buffer& list_pixels(Recorder& recorder, const Frame& frame, const GpuImage& marks, std::uint32_t empty,
                          std::string_view name, std::uint32_t first_row, std::uint32_t row_end,
                          const std::optional<WantedSamples>& wanted = std::nullopt);

/// Offset in bytes of a list's length, a 32-bit word.
inline constexpr vk::DeviceSize kListLengthOffset = 12;

/// An empty list for a shader to append to (PELLUCID_APPENDED_LIST).
const Buffer& start_pixel_list(Recorder& recorder, const Frame& frame, std::string_view name);

/// A list of pixels in host memory. Lists are mapped only on devices that are CPUs.
class PixelListOnHost {
public:
    explicit PixelListOnHost(const Buffer& list);
    std::span<const std::uint32_t> pixels() const;  ///< x | y << 16
    /// Array with capacity for every pixel of the image. The first pixels().size() are in the list.
    std::uint32_t* data() const;
    void set_size(std::uint32_t size) const;

private:
    std::uint32_t* words_;
};

}  // namespace pellucid
