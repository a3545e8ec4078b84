#pragma once

// Images too large for one frame are drawn tile by tile.
#include "gpu/device.h"
#include "gpu/structs.h"

#include <pellucid/renderer.h>

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace pellucid {

/// A rectangle of an image, pixels.
struct Tile {
    glm::uvec2 first{0}, size{0};
    std::uint64_t pixels() const { return std::uint64_t(size.x) * size.y; }
    vk::Extent2D extent() const { return {size.x, size.y}; }
    bool holds(const Tile& other) const {
        return glm::all(glm::lessThanEqual(first, other.first)) &&
               glm::all(glm::lessThanEqual(other.first + other.size, first + size));
    }
};

/// Memory of this machine, bytes.
std::uint64_t host_memory();

/// Most pixels of a frame by the device's limits. `bytes_per_pixel`: of the technique's largest storage buffer. Frames
/// of a software driver use at most half of this machine's memory.
std::uint64_t most_tile_pixels(const Device& device, std::uint32_t bytes_per_pixel);

/// The part of an image that contains glass, with a margin. `view`: constants of the whole image. `corners` (world):
/// their hull contains all glass. A tile without pixels if there is no glass; std::nullopt if the eye is among the
/// corners.
std::optional<Tile> tile_of_glass(const gpu::FrameConstants& view, std::span<const glm::vec3> corners);

/// Splits an image of `size` in halves, across the longer side, until each tile has at most `most_pixels` and fits the
/// device's images. `kept_whole` becomes a tile of its own if it is small enough. Tiles are in reverse order, to be
/// taken from the end.
std::vector<Tile> tiles_of(glm::uvec2 size, const std::optional<Tile>& kept_whole, std::uint64_t most_pixels,
                           const Device& device);

/// Splits every tile in half. Returns false, and splits nothing, if all tiles are so small that their size cannot be
/// why one did not fit.
bool halve(std::vector<Tile>& tiles);

/// Copies the pixels of a tile to or from an image.
void paste(Image& picture, const Image& part, const Tile& tile);
Image part_of(const Image& picture, const Tile& tile);

/// Adds the images and counts of a tile to the result of an image of `size`. Warnings are not copied.
void add_tile(RenderResult& result, RenderResult&& part, const Tile& tile, glm::uvec2 size);

/// Progress of a part of the work, from share `from` to share `to` of the whole.
inline Progress part_of(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [&whole, from, to](double done) { whole(from + done * (to - from)); };
}

/// Progress over all tiles. It never decreases, though a tile may start again.
class TileProgress {
public:
    TileProgress(Progress whole, glm::uvec2 size)
        : whole_(std::move(whole)), pixels_(double(size.x) * double(size.y)) {}
    /// `done`: share of the tile, 0..1.
    void show(const Tile& tile, double done) {
        const double share = (drawn_ + done * double(tile.pixels())) / pixels_;
        if (!whole_ || share <= shown_) return;
        whole_(shown_ = share);
    }
    void finish(const Tile& tile) { drawn_ += double(tile.pixels()); }
    explicit operator bool() const { return bool(whole_); }

private:
    Progress whole_;
    double pixels_, drawn_ = 0.0, shown_ = -1.0;
};

}  // namespace pellucid
