#pragma once

// Pictures that one frame cannot hold are drawn tile by tile.
#include "gpu/device.h"
#include "gpu/structs.h"

#include <pellucid/renderer.h>

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace pellucid {

/// A part of a picture, pixels.
struct Tile {
    glm::uvec2 first{0}, size{0};
    std::uint64_t pixels() const { return std::uint64_t(size.x) * size.y; }
    vk::Extent2D extent() const { return {size.x, size.y}; }
    bool holds(const Tile& other) const {
        return glm::all(glm::lessThanEqual(first, other.first)) &&
               glm::all(glm::lessThanEqual(other.first + other.size, first + size));
    }
};

/// Of this machine, bytes.
std::uint64_t host_memory();

/// How many pixels a frame of a device holds, as far as its limits tell. `bytes_per_pixel` is of the technique's largest
/// storage buffer. A software driver's frames take half of this machine's memory at most.
std::uint64_t most_tile_pixels(const Device& device, std::uint32_t bytes_per_pixel);

/// The part of a picture in which glass is seen, with a margin. `view` is of the whole picture; the hull of `corners`
/// (world) holds all glass. Empty if there is none, nothing if the eye is among the corners.
std::optional<Tile> tile_of_glass(const gpu::FrameConstants& view, std::span<const glm::vec3> corners);

/// A picture of `size` cut in halves, across the longer side, until no tile has more than `most_pixels` or is longer
/// than the device's images. A part that is to stay whole becomes a tile of its own if it is small enough. The first
/// tile is the last, so that they can be taken from the end.
std::vector<Tile> tiles_of(glm::uvec2 size, const std::optional<Tile>& kept_whole, std::uint64_t most_pixels,
                           const Device& device);

/// Cuts every tile in half. False, and nothing is cut, if they are so small already that their size cannot be the reason
/// why one did not fit.
bool halve(std::vector<Tile>& tiles);

/// Copies the pixels of a tile to or from a picture.
void paste(Image& picture, const Image& part, const Tile& tile);
Image part_of(const Image& picture, const Tile& tile);

/// Adds the picture and the counts of a tile to the result of a picture of `size`; warnings are left out.
void add_tile(RenderResult& result, RenderResult&& part, const Tile& tile, glm::uvec2 size);

/// Progress of a part of the work, which takes the whole from one share to another.
inline Progress part_of(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [&whole, from, to](double done) { whole(from + done * (to - from)); };
}

/// Progress over all tiles, which never falls though a tile may begin anew.
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
