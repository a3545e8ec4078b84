#include "volume/upload_volumes.h"

#include "core/math.h"
#include "volume/volume_records.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

namespace pellucid {
namespace {

constexpr auto kIndexFormat = vk::Format::eR32G32B32A32Sfloat;
constexpr auto kBrickFormat = vk::Format::eR32G32Sfloat;
constexpr auto kMediumFormat = vk::Format::eR16G16B16A16Sfloat;
constexpr vk::ImageUsageFlags kUsage =
    vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst | vk::ImageUsageFlagBits::eTransferSrc;

using Half4 = std::uint64_t;
/// Clamps to the largest finite half. Voxels at that limit let no light through.
Half4 half4(glm::vec4 v) { return glm::packHalf4x16(glm::min(v, glm::vec4(65504.0f))); }

/// Texels of the index. A texel holds four voxels along x: the one before its own, its own, and the next two. So an
/// interpolation reads a row of four at once. Beyond the faces the index is extrapolated. An empty field is vacuum.
std::vector<glm::vec4> index_texels(const Volume& volume, const std::vector<float>& n) {
    std::vector<glm::vec4> texels(volume.voxel_count(), glm::vec4(1.0f));
    if (n.empty()) return texels;
    const std::size_t width = volume.size.x;
    for (std::size_t row = 0; row < n.size(); row += width) {
        const auto at = [&](std::ptrdiff_t x) {
            const float* const own = &n[row];
            if (x < 0) return 2.0f * own[0] - own[1];
            const auto beyond = x + 1 - std::ptrdiff_t(width);
            return beyond <= 0 ? own[x] : own[width - 1] + float(beyond) * (own[width - 1] - own[width - 2]);
        };
        for (std::size_t x = 0; x < width; ++x) {
            const auto i = std::ptrdiff_t(x);
            texels[row + x] = {at(i - 1), at(i), at(i + 1), at(i + 2)};
        }
    }
    return texels;
}

constexpr unsigned kBrick = 8;  // twin of kBrick in volume_field.glsl
glm::uvec3 bricks_of(glm::uvec3 size) { return (size + kBrick - 1u) / kBrick; }

/// Whether a field is uniform in a brick and in the voxels around it that interpolation reads.
template <class T>
bool is_even(const Volume& volume, const std::vector<T>& field, glm::uvec3 brick) {
    if (field.empty()) return true;
    const glm::uvec3 size = volume.size, from = glm::max(kBrick * brick, 1u) - 1u;
    const glm::uvec3 to = glm::min(kBrick * (brick + 1u) + 2u, size);
    const T first = field[from.x + size.x * (from.y + std::size_t(size.y) * from.z)];
    for (unsigned z = from.z; z < to.z; ++z)
        for (unsigned y = from.y; y < to.y; ++y) {
            const T* const row = &field[size.x * (y + std::size_t(size.y) * z)];
            for (unsigned x = from.x; x < to.x; ++x)
                if (row[x] != first) return false;
        }
    return true;
}

std::vector<glm::vec2> brick_texels(const Volume& volume, const std::vector<float>& n) {
    const glm::uvec3 count = bricks_of(volume.size), size = volume.size;
    std::vector<glm::vec2> texels;
    glm::uvec3 b;
    for (b.z = 0; b.z < count.z; ++b.z)
        for (b.y = 0; b.y < count.y; ++b.y)
            for (b.x = 0; b.x < count.x; ++b.x) {
                const glm::uvec3 at = glm::min(kBrick * b, size - 1u);
                const float own = n.empty() ? 1.0f : n[at.x + size.x * (at.y + std::size_t(size.y) * at.z)];
                const bool media = is_even(volume, volume.sigma_a, b) && is_even(volume, volume.sigma_s, b) &&
                                   is_even(volume, volume.g, b) && is_even(volume, volume.emission, b) &&
                                   is_even(volume, volume.boundary, b);
                texels.emplace_back(is_even(volume, n, b) ? own : 0.0f, media ? 1.0f : 0.0f);
            }
    return texels;
}

template <class Texel>
std::vector<Half4> half_texels(const Volume& volume, const Texel& texel) {
    std::vector<Half4> texels(volume.voxel_count());
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = half4(texel(i));
    return texels;
}

/// Value of a field at a voxel; 0 if the field is empty.
template <class T>
T value(const std::vector<T>& field, std::size_t i) {
    return field.empty() ? T(0) : field[i];
}

/// An image for boxes of texels; a single texel of zeros if there are none.
GpuImage image_of_boxes(const Device& device, const char* name, vk::Format format, const PackedBoxes& boxes) {
    const glm::uvec3 extent = boxes.first.empty() ? glm::uvec3(1) : boxes.extent;
    GpuImage image(device, name, format, vk::Extent3D{extent.x, extent.y, extent.z}, kUsage);
    if (!boxes.first.empty()) return image;
    const std::array<std::byte, 16> zeros{};
    upload_box(device, image, {}, {1, 1, 1}, std::span(zeros).first(texel_size(format)));
    return image;
}

template <class Texels>
void fill_box(const Device& device, const GpuImage& image, glm::uvec3 first, glm::uvec3 size, const Texels& texels) {
    const glm::ivec3 at(first);
    upload_box(device, image, {at.x, at.y, at.z}, {size.x, size.y, size.z}, std::as_bytes(std::span(texels)));
}

/// The image of a property of the medium for all volumes, at `boxes`. `wanted`: a volume has the property.
template <class Texels>
GpuImage medium_image(const Device& device, const Scene& scene, const char* name, const PackedBoxes& boxes, bool wanted,
                      const Texels& texels_of) {
    GpuImage image = image_of_boxes(device, name, kMediumFormat, wanted ? boxes : PackedBoxes{});
    for (std::size_t v = 0; wanted && v < scene.volumes.size(); ++v)
        fill_box(device, image, boxes.first[v], scene.volumes[v]->size, texels_of(*scene.volumes[v]));
    return image;
}

/// Box numbers of a volume's index per colour. They are equal for a volume that does not disperse.
struct IndexBoxes {
    std::size_t red, green, blue;
};

/// Positions of a volume's boxes in the images. All placements of the volume share them.
struct VolumePlaces {
    glm::uvec3 medium, red, green, blue;
};

VolumeRecord record_of(const Volume& volume, const VolumeObject& object, const VolumePlaces& at) {
    const glm::dmat4 world_from_volume(object.world_from_volume);
    const glm::dmat4 volume_from_voxel =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(volume.low)), glm::dvec3(double(volume.voxel)));
    const glm::dmat4 world_from_voxel = world_from_volume * volume_from_voxel;
    return {.voxel_from_world = glm::mat4(glm::inverse(world_from_voxel)),
            .world_from_voxel = glm::mat4(world_from_voxel),
            .size = glm::vec3(volume.size),
            .voxel = float(glm::length(glm::dvec3(world_from_voxel[0]))),
            .first_texel = glm::ivec3(at.medium),
            .flags = (volume.n_red.empty() ? 0u : kDispersiveVolume) | (object.objects.empty() ? 0u : kMeshVolume),
            .first_index = glm::ivec4(at.green, 0),
            .first_red = glm::ivec4(at.red, 0),
            .first_blue = glm::ivec4(at.blue, 0)};
}

double content(const VolumeRecord& record) {
    const double voxel = double(record.voxel);
    return double(record.size.x) * double(record.size.y) * double(record.size.z) * voxel * voxel * voxel;
}

/// Whether the world-space bounding boxes of two placements overlap. Placements with separate boxes never overlap.
bool may_overlap(const VolumeRecord& a, const VolumeRecord& b) {
    const auto box = [](const VolumeRecord& record) {
        const glm::mat3 m(record.world_from_voxel);
        const glm::vec3 half =
            0.5f * (glm::abs(m[0]) * record.size.x + glm::abs(m[1]) * record.size.y + glm::abs(m[2]) * record.size.z);
        const glm::vec3 middle(record.world_from_voxel * glm::vec4(0.5f * record.size, 1.0f));
        return std::pair(middle - half, middle + half);
    };
    const auto [low_a, high_a] = box(a);
    const auto [low_b, high_b] = box(b);
    return glm::all(glm::lessThan(low_a, high_b)) && glm::all(glm::lessThan(low_b, high_a));
}

}  // namespace

VolumeImages upload_volumes(const Device& device, const Scene& scene) {
    const auto any = [&](auto&& has) {
        return std::any_of(scene.volumes.begin(), scene.volumes.end(),
                           [&](const auto& volume) { return has(*volume); });
    };
    std::vector<glm::uvec3> sizes, index_sizes;
    std::vector<IndexBoxes> index_boxes;
    for (const auto& volume : scene.volumes) {
        sizes.push_back(volume->size);
        const std::size_t own = index_sizes.size();
        const bool parts = !volume->n_red.empty();
        index_boxes.push_back({own + (parts ? 1 : 0), own, own + (parts ? 2 : 0)});
        index_sizes.insert(index_sizes.end(), parts ? 3 : 1, bricks_of(volume->size));
    }
    const std::uint32_t limit = device.limits().maxImageDimension3D;
    const PackedBoxes boxes = pack_boxes(sizes, limit), brick_places = pack_boxes(index_sizes, limit / kBrick);
    PackedBoxes places = brick_places;  // boxes of the index, laid out like those of the bricks
    places.extent *= kBrick;
    for (glm::uvec3& first : places.first) first *= kBrick;
    VolumeImages result;
    result.absorbs = any([](const Volume& v) { return !v.sigma_a.empty(); });
    result.reflects = any([](const Volume& v) { return !v.boundary.empty(); });
    result.scatters = any([](const Volume& v) { return !v.sigma_s.empty(); });
    result.emits = any([](const Volume& v) { return !v.emission.empty(); });
    result.disperses = any([](const Volume& v) { return !v.n_red.empty(); });

    result.index = image_of_boxes(device, "index of volumes", kIndexFormat, places);
    result.bricks = image_of_boxes(device, "bricks of volumes", kBrickFormat, brick_places);
    for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
        const Volume& volume = *scene.volumes[v];
        const auto fill = [&](std::size_t box, const std::vector<float>& n) {
            fill_box(device, result.index, places.first[box], volume.size, index_texels(volume, n));
            fill_box(device, result.bricks, brick_places.first[box], bricks_of(volume.size), brick_texels(volume, n));
        };
        fill(index_boxes[v].green, volume.n);
        if (volume.n_red.empty()) continue;
        fill(index_boxes[v].red, volume.n_red);
        fill(index_boxes[v].blue, volume.n_blue);
    }
    result.absorption = medium_image(
        device, scene, "absorption of volumes", boxes, result.absorbs || result.reflects, [](const Volume& v) {
            return half_texels(
                v, [&](std::size_t i) { return glm::vec4(v.voxel * value(v.sigma_a, i), value(v.boundary, i)); });
        });
    result.scattering =
        medium_image(device, scene, "scattering of volumes", boxes, result.scatters, [](const Volume& v) {
            return half_texels(v,
                               [&](std::size_t i) { return glm::vec4(v.voxel * value(v.sigma_s, i), value(v.g, i)); });
        });
    result.emission = medium_image(device, scene, "emission of volumes", boxes, result.emits, [](const Volume& v) {
        return half_texels(v, [&](std::size_t i) { return glm::vec4(v.voxel * value(v.emission, i), 0.0f); });
    });

    std::vector<VolumeRecord> records;
    for (const VolumeObject& object : scene.volume_objects) {
        const auto v = std::size_t(object.volume);
        const IndexBoxes& own = index_boxes[v];
        records.push_back(
            record_of(*scene.volumes[v], object,
                      {boxes.first[v], places.first[own.red], places.first[own.green], places.first[own.blue]}));
    }
    std::stable_sort(records.begin(), records.end(),
                     [](const VolumeRecord& a, const VolumeRecord& b) { return content(a) < content(b); });
    for (std::size_t a = 0; a < records.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            result.overlapping = result.overlapping || may_overlap(records[a], records[b]);
    result.count = std::uint32_t(records.size());
    result.records = Buffer(device, "volumes", records.size() * sizeof(VolumeRecord),
                            vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst |
                                vk::BufferUsageFlagBits::eTransferSrc);
    upload(device, result.records, std::as_bytes(std::span(records)));
    return result;
}

}  // namespace pellucid
