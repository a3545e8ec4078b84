#include "render/tiles.h"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace pellucid {
namespace {

constexpr std::uint32_t kLongestTile = 1u << 15;    ///< lists of pixels have 16 bits per coordinate
constexpr std::uint64_t kSmallTile = 1u << 16;      ///< pixels
constexpr std::uint64_t kFrameBytesPerPixel = 400;  ///< approximate total of all images and buffers

template <class T>
void copy_rows(const T* from, std::size_t from_pitch, T* to, std::size_t to_pitch, std::size_t count,
               std::uint32_t rows) {
    for (std::uint32_t y = 0; y < rows; ++y) std::copy_n(from + y * from_pitch, count, to + y * to_pitch);
}

std::size_t index_of(const Tile& tile, std::size_t width) { return tile.first.y * width + tile.first.x; }

void add_times(std::vector<PassTime>& times, const std::vector<PassTime>& more) {
    for (const PassTime& pass : more) {
        const auto same =
            std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == pass.name; });
        if (same == times.end())
            times.push_back(pass);
        else
            same->time_ms += pass.time_ms;
    }
}

void append_halves(const Tile& tile, std::vector<Tile>& tiles) {
    const int axis = tile.size.x > tile.size.y ? 0 : 1;
    Tile near = tile, far = tile;
    near.size[axis] = (tile.size[axis] + 1) / 2;
    far.first[axis] += near.size[axis];
    far.size[axis] -= near.size[axis];
    if (far.pixels() > 0) tiles.push_back(far);
    tiles.push_back(near);
}

/// Splits `whole` into `part` and the rest above, below, left and right of it.
std::vector<Tile> around(const Tile& whole, const Tile& part) {
    const glm::uvec2 first = part.first, end = part.first + part.size, size = whole.size;
    return {{{0, end.y}, {size.x, size.y - end.y}},
            {{end.x, first.y}, {size.x - end.x, part.size.y}},
            {{0, first.y}, {first.x, part.size.y}},
            {{0, 0}, {size.x, first.y}},
            part};
}

}  // namespace

std::uint64_t host_memory() { return std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE)); }

std::uint64_t most_tile_pixels(const Device& device, std::uint32_t bytes_per_pixel) {
    const std::uint64_t most =
        std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation()) / bytes_per_pixel;
    return device.is_cpu() ? std::min(most, host_memory() / 2 / kFrameBytesPerPixel) : most;
}

std::optional<Tile> tile_of_glass(const gpu::FrameConstants& view, std::span<const glm::vec3> corners) {
    if (corners.empty()) return Tile{};
    constexpr float kMargin = 2.0f;  // pixels; samples are offset by half a pixel
    glm::vec2 low(std::numeric_limits<float>::max()), high(-low);
    for (const glm::vec3& corner : corners) {
        const glm::vec3 p = view.view_from_world * glm::vec4(corner, 1.0f);
        if (-p.z <= 0.0f && view.orthographic == 0) return std::nullopt;
        const glm::vec2 film = view.orthographic != 0 ? glm::vec2(p) : glm::vec2(p) / -p.z;
        const glm::vec2 pixel(film.x - view.film.x, view.film.y - film.y);
        low = glm::min(low, pixel / glm::vec2(view.film.z, view.film.w));
        high = glm::max(high, pixel / glm::vec2(view.film.z, view.film.w));
    }
    const glm::vec2 size(view.width, view.height);
    const glm::uvec2 first(glm::clamp(glm::floor(low) - kMargin, glm::vec2(0.0f), size));
    const glm::uvec2 end(glm::clamp(glm::ceil(high) + kMargin, glm::vec2(0.0f), size));
    return Tile{first, end - first};
}

std::vector<Tile> tiles_of(glm::uvec2 size, const std::optional<Tile>& kept_whole, std::uint64_t most_pixels,
                           const Device& device) {
    const std::uint32_t longest = std::min(device.limits().maxImageDimension2D, kLongestTile);
    const auto fits = [&](const Tile& tile) {
        return tile.pixels() <= most_pixels && std::max(tile.size.x, tile.size.y) <= longest;
    };
    const Tile whole{glm::uvec2(0), size};
    std::vector<Tile> tiles, cut{whole};
    if (!fits(whole) && kept_whole && kept_whole->pixels() > 0 && fits(*kept_whole)) cut = around(whole, *kept_whole);
    while (!cut.empty()) {
        const Tile tile = cut.back();
        cut.pop_back();
        if (tile.pixels() > 1 && !fits(tile))
            append_halves(tile, cut);
        else if (tile.pixels() > 0)
            tiles.push_back(tile);
    }
    std::reverse(tiles.begin(), tiles.end());
    return tiles;
}

bool halve(std::vector<Tile>& tiles) {
    if (std::all_of(tiles.begin(), tiles.end(), [](const Tile& tile) { return tile.pixels() <= kSmallTile; }))
        return false;
    std::vector<Tile> halves;
    for (const Tile& tile : tiles) append_halves(tile, halves);
    tiles = std::move(halves);
    return true;
}

void paste(Image& picture, const Image& part, const Tile& tile) {
    const std::size_t channels = std::size_t(part.channels), width = std::size_t(picture.width);
    copy_rows(part.pixels.data(), channels * tile.size.x, picture.pixels.data() + channels * index_of(tile, width),
              channels * width, channels * tile.size.x, tile.size.y);
}

Image part_of(const Image& picture, const Tile& tile) {
    Image part(int(tile.size.x), int(tile.size.y), picture.channels);
    const std::size_t channels = std::size_t(part.channels), width = std::size_t(picture.width);
    copy_rows(picture.pixels.data() + channels * index_of(tile, width), channels * width, part.pixels.data(),
              channels * tile.size.x, channels * tile.size.x, tile.size.y);
    return part;
}

void add_tile(RenderResult& result, RenderResult&& part, const Tile& tile, glm::uvec2 size) {
    const bool whole = tile.size == size;
    const auto add_image = [&](Image& picture, Image&& image) {
        if (whole) {
            picture = std::move(image);
        } else if (!image.pixels.empty()) {
            if (picture.pixels.empty()) picture = Image(int(size.x), int(size.y), image.channels);
            paste(picture, image, tile);
        }
    };
    add_image(result.radiance, std::move(part.radiance));
    add_image(result.sample_counts, std::move(part.sample_counts));
    for (auto& [name, image] : part.aovs) add_image(result.aovs[name], std::move(image));
    if (whole) {
        result.paths = std::move(part.paths);
    } else if (!part.paths.empty()) {
        result.paths.resize(std::size_t(size.x) * size.y);
        copy_rows(part.paths.data(), tile.size.x, result.paths.data() + index_of(tile, size.x), size.x, tile.size.x,
                  tile.size.y);
    }
    result.frames.resize(std::max(result.frames.size(), part.frames.size()));
    for (std::size_t i = 0; i < part.frames.size(); ++i) add_times(result.frames[i], part.frames[i]);
    result.layer_passes += part.layer_passes;
    result.cut_rays += part.cut_rays;
    result.covered += part.covered;
    for (std::size_t i = 0; i < result.status.size(); ++i) result.status[i] += part.status[i];
    result.side_conflicts += part.side_conflicts;
}

}  // namespace pellucid
