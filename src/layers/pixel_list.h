#pragma once

#include "gpu/frame.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace pellucid {

/// Lists the pixels of rows `first_row` to `row_end` at which layer 0 of `marks` (R32UI) is not `empty`, for
/// Recorder::compute_indirect(); shaders read it through pixel_list.glsl, as "PixelList". In no particular order. `wanted`:
/// those that want this frame's sample only.
const Buffer& list_pixels(Recorder& recorder, const Frame& frame, const GpuImage& marks, std::uint32_t empty,
                          std::string_view name, std::uint32_t first_row, std::uint32_t row_end,
                          const std::optional<WantedSamples>& wanted = std::nullopt);

/// Where in a list its length stands, as a word; bytes.
inline constexpr vk::DeviceSize kListLengthOffset = 12;

/// An empty list for a shader to append to (PELLUCID_APPENDED_LIST).
const Buffer& start_pixel_list(Recorder& recorder, const Frame& frame, std::string_view name);

/// A list of pixels in host memory: lists are mapped on devices that are CPUs.
class PixelListOnHost {
public:
    explicit PixelListOnHost(const Buffer& list);
    std::span<const std::uint32_t> pixels() const;  ///< x | y << 16
    /// Room for as many pixels as the picture has, of which the first pixels().size() are in the list.
    std::uint32_t* data() const;
    void set_size(std::uint32_t size) const;

private:
    std::uint32_t* words_;
};

}  // namespace pellucid
