#include "gpu/texture_pages.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <bit>
#include <cstring>

namespace pellucid {
namespace {

struct Placement {
    std::uint32_t page;
    std::uint32_t x, y;
};

/// Side of the square pages. The largest image decides it, and small images share a page.
std::uint32_t page_size(const Device& device, const Scene& scene, const std::vector<int>& images) {
    std::uint32_t largest = 1;
    for (const int index : images) {
        const Image& image = scene.images[std::size_t(index)];
        const auto side = std::uint32_t(std::max(image.width, image.height));
        if (side > device.limits().maxImageDimension2D) {
            throw Error(fmt::format("{}: image '{}' is {}x{}; {} allows up to {}", scene.source,
                                    scene.image_names[std::size_t(index)], image.width, image.height,
                                    device.info().name, device.limits().maxImageDimension2D));
        }
        largest = std::max(largest, side);
    }
    return std::min(std::bit_ceil(largest), device.limits().maxImageDimension2D);
}

std::map<int, Placement> place_images(const Scene& scene, const std::vector<int>& images, std::uint32_t size,
                                      std::uint32_t& page_count) {
    std::vector<stbrp_rect> waiting;
    for (const int index : images) {
        const Image& image = scene.images[std::size_t(index)];
        waiting.push_back({.id = index, .w = image.width, .h = image.height, .x = 0, .y = 0, .was_packed = 0});
    }
    std::map<int, Placement> placements;
    std::vector<stbrp_node> nodes(size);
    page_count = 0;
    while (!waiting.empty()) {
        stbrp_context context;
        stbrp_init_target(&context, int(size), int(size), nodes.data(), int(nodes.size()));
        stbrp_pack_rects(&context, waiting.data(), int(waiting.size()));
        std::erase_if(waiting, [&](const stbrp_rect& rect) {
            if (rect.was_packed) placements[rect.id] = {page_count, std::uint32_t(rect.x), std::uint32_t(rect.y)};
            return rect.was_packed != 0;
        });
        ++page_count;
    }
    return placements;
}

void paint(const Image& image, const Placement& place, std::uint32_t size, std::vector<std::uint8_t>& page) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const float* source = image.at(x, y);
            std::uint8_t* texel =
                &page[4 * (std::size_t(place.y + std::uint32_t(y)) * size + place.x + std::uint32_t(x))];
            for (int c = 0; c < 4; ++c) {
                const bool grey = image.channels < 3;
                const float value = c == 3 ? (image.channels == 4   ? source[3]
                                              : image.channels == 2 ? source[1]
                                                                    : 1.0f)
                                           : source[grey ? 0 : c];
                texel[c] = std::uint8_t(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
            }
        }
    }
}

}  // namespace

std::uint32_t TextureTable::add(const Texture& texture, bool srgb) {
    if (texture.image < 0) return PELLUCID_NO_TEXTURE;
    const glm::mat3& m = texture.uv_from_texcoord;
    gpu::TextureRecord record{};
    record.uv_row0 = {m[0][0], m[1][0], m[2][0], 0.0f};
    record.uv_row1 = {m[0][1], m[1][1], m[2][1], 0.0f};
    record.wrap_u = std::uint32_t(texture.wrap_u);
    record.wrap_v = std::uint32_t(texture.wrap_v);
    record.flags = (texture.nearest ? PELLUCID_TEXTURE_NEAREST : 0u) | (srgb ? PELLUCID_TEXTURE_SRGB : 0u) |
                   (texture.texcoord_set == 1 ? PELLUCID_TEXTURE_SECOND_SET : 0u);
    records_.push_back(record);
    images_.push_back(texture.image);
    return std::uint32_t(records_.size() - 1);
}

GpuImage TextureTable::upload_pages(const Device& device) {
    std::vector<int> used = images_;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());

    const std::uint32_t size = page_size(device, scene_, used);
    std::uint32_t page_count = 0;
    const std::map<int, Placement> placements = place_images(scene_, used, size, page_count);
    GpuImage pages(device, "the scene's texture pages", vk::Format::eR8G8B8A8Unorm, {size, size},
                   std::max(page_count, 1u), vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst);
    for (std::uint32_t page = 0; page < pages.layers(); ++page) {
        std::vector<std::uint8_t> texels(4 * std::size_t(size) * size);
        for (const auto& [index, place] : placements) {
            if (place.page == page) paint(scene_.images[std::size_t(index)], place, size, texels);
        }
        upload(device, pages, page, std::as_bytes(std::span(texels)));
    }
    for (std::size_t i = 0; i < records_.size(); ++i) {
        const Placement& place = placements.at(images_[i]);
        const Image& image = scene_.images[std::size_t(images_[i])];
        records_[i].page = place.page;
        records_[i].x = place.x;
        records_[i].y = place.y;
        records_[i].width = std::uint32_t(image.width);
        records_[i].height = std::uint32_t(image.height);
    }
    return pages;
}

}  // namespace pellucid
