#include "volume/upload_volumes.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace pellucid {

PackedBoxes pack_boxes(const std::vector<glm::uvec3>& sizes, std::uint32_t limit) {
    std::vector<std::size_t> order(sizes.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    // Boxes of equal width and height lie behind each other along z, the largest first.
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(sizes[a].y, sizes[a].x) > std::pair(sizes[b].y, sizes[b].x);
    });
    PackedBoxes packed;
    packed.first.resize(sizes.size());
    glm::uvec3 at(0);                     // position of the next box
    std::uint32_t width = 0, height = 0;  // width of the layer of rows along y, height of the row along z
    for (const std::size_t box : order) {
        const glm::uvec3 size = sizes[box];
        if (at.z + size.z > limit) at = {at.x, at.y + height, 0}, height = 0;
        if (at.y + size.y > limit) at = {at.x + width, 0, 0}, width = height = 0;
        if (at.x + size.x > limit || at.y + size.y > limit || at.z + size.z > limit)
            throw Error(
                fmt::format("volumes: a 3D image has {} voxels along an axis at most, which is too little for all "
                            "of them ({} x {} x {} is one)",
                            limit, size.x, size.y, size.z));
        packed.first[box] = at;
        packed.extent = glm::max(packed.extent, at + size);
        width = std::max(width, size.x);
        height = std::max(height, size.y);
        at.z += size.z;
    }
    return packed;
}

}  // namespace pellucid
