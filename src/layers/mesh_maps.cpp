#include "layers/mesh_maps.h"

#include "layers/map_building.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// Twin of MappedObject in object_walk.glsl.
struct MappedObject {
    glm::vec3 low;
    std::uint32_t first_map;
    glm::vec3 high;
    std::uint32_t first_triangle;
};
static_assert(sizeof(MappedObject) == 32);

/// Extent of a mesh's maps: the mesh's box plus half a texel on each side, so that no surface lies on the border.
struct MapBox {
    glm::vec3 low, high;
    float texel;
};

MapBox box_of(const GpuMesh& mesh, std::uint32_t resolution) {
    if (mesh.triangle_count == 0) return {glm::vec3(1.0f), glm::vec3(-1.0f), 1.0f};
    const glm::vec3 size = mesh.high - mesh.low;
    const float longest = std::max({size.x, size.y, size.z});
    // Limits the resolution to float precision, for a mesh that is a point or is tiny and far from its origin.
    const float finest = 1e-5f * std::max(glm::length(mesh.low), glm::length(mesh.high));
    const float texel = std::max({longest / float(std::max(resolution, 2u) - 1), finest, 1e-30f});
    return {mesh.low - 0.5f * texel, mesh.high + 0.5f * texel, texel};
}

MapRecord record_along(std::uint32_t axis, const MapBox& box) {
    const int depth = int(axis), across = (depth + 1) % 3, down = (depth + 2) % 3;
    const float scale = 1.0f / box.texel, deep = 1.0f / (box.high[depth] - box.low[depth]);
    glm::vec4 x(0.0f), y(0.0f), q(0.0f);
    x[across] = y[down] = scale;
    x.w = -scale * box.low[across];
    y.w = -scale * box.low[down];
    q[depth] = deep;
    q.w = -deep * box.low[depth];
    MapProjection projection;
    projection.map_from_world = glm::transpose(glm::mat4(x, y, q, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)));
    projection.near_w = 0.5f;
    const auto texels = [&](int side) {
        return std::uint32_t(std::max(std::ceil((box.high[side] - box.low[side]) * scale - 1e-3f), 1.0f));
    };
    projection.extent = vk::Extent2D{texels(across), texels(down)};
    return record_of(projection);
}

/// Grows a buffer that lives from frame to frame.
void make_room(Buffer& buffer, const Device& device, const char* name, std::uint64_t bytes,
               vk::Format texels = vk::Format::eUndefined) {
    using Usage = vk::BufferUsageFlagBits;
    bytes = std::max<std::uint64_t>(bytes, 16);
    if (buffer.size() >= bytes) return;
    buffer = Buffer();  // freed first
    buffer =
        Buffer(device, name, bytes, Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst, false, texels);
}

/// Largest number of items of a size in a buffer of the device, in whole blocks.
std::uint32_t most_map_items(const Device& device, vk::DeviceSize item_size) {
    const vk::DeviceSize bytes = std::min<vk::DeviceSize>(device.max_storage_binding(), device.max_allocation());
    const vk::DeviceSize most =
        std::min<vk::DeviceSize>(bytes / item_size, std::min(device.limits().maxTexelBufferElements, 0x7ffffffeu));
    return std::uint32_t(most / kMapRangeBlock * kMapRangeBlock);
}

constexpr std::uint32_t kCoarsestLevel = 8;  // texels across; if even such maps do not fit, memory is too small

}  // namespace

MeshMaps::MeshMaps()
    : found_("surfaces in texels of a mesh", kMapFoundSize, kMapFormat), tiles_("tiles of a mesh", kMapTileSize) {}

SurfaceMap MeshMaps::buffers() const {
    return {&maps_, &triangles_, &normals_, &texels_, &ranges_, &records_, &pyramid_, &objects_};
}

/// Meshes with many triangles get finer maps, because a ray tests all triangles in each texel that it crosses. Texels
/// at walls seen edge-on hold many times the mean number.
std::uint32_t MeshMaps::texels_across(const GpuMesh& mesh) const {
    constexpr double kMostTrianglesPerTexel = 0.5;
    const double texels = double(resolution_) * resolution_ * kMostTrianglesPerTexel;
    const double finer = std::max(std::sqrt(double(mesh.triangle_count) / texels), 1.0);
    return std::uint32_t(std::min(std::ceil(texels_across_ * finer), 8192.0));
}

/// Whether the maps of every mesh still fit their allocated ranges after it has moved.
bool MeshMaps::fits(const Frame& frame) const {
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
        if (!meshes_[m].shown) continue;
        const MapBox box = box_of(frame.scene.meshes[m], texels_across(frame.scene.meshes[m]));
        for (std::uint32_t axis = 0; axis < kAxes; ++axis) {
            const MapRecord record = record_along(axis, box);
            const Place& place = meshes_[m].places[axis];
            if (texel_count(record) > place.texels || node_count(record) > place.nodes) return false;
        }
    }
    return true;
}

MeshMaps::Room MeshMaps::place_maps(const GpuScene& scene) {
    Room room;
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
        Mapped& mesh = meshes_[m];
        mesh.built = false;
        if (!mesh.shown) continue;
        const MapBox box = box_of(scene.meshes[m], texels_across(scene.meshes[m]));
        for (std::uint32_t axis = 0; axis < kAxes; ++axis) {
            const MapRecord record = record_along(axis, box);
            Place& place = mesh.places[axis];
            place.first_texel = room.texels;
            place.texels = texel_count(record);
            place.first_node = room.nodes;
            place.nodes = node_count(record);
            // A line along an axis crosses most closed surfaces two or four times, over half of their box.
            if (place.records == 0) place.records = whole_range_blocks(place.texels + scene.meshes[m].triangle_count);
            place.first_record = room.records;
            room.texels += place.texels;
            room.nodes += place.nodes;
            room.records += place.records;
            room.found = std::max(room.found, place.records);
        }
    }
    return room;
}

void MeshMaps::lay_out(const Frame& frame) {
    const Device& device = frame.workspace.device();
    const GpuScene& scene = frame.scene;
    const auto tiles = [&] { return std::uint64_t(texels_across_) * texels_across_ / 4 + 1024; };
    tiles_.set_capacity(std::max<std::uint64_t>(tiles_.capacity(), tiles()));
    Room room = place_maps(scene);
    const auto too_much = [&] {
        return room.texels > most_map_items(device, kMapTexelSize) ||
               room.nodes > most_map_items(device, kMapNodeSize) || room.records > found_.limit(device) ||
               tiles_.capacity() > tiles_.limit(device);
    };
    // Coarser maps find the same surfaces, but take more time.
    while (too_much() && texels_across_ > kCoarsestLevel) {
        texels_across_ = std::max(texels_across_ * 4 / 5, kCoarsestLevel);
        tiles_.set_capacity(tiles());
        for (Mapped& mesh : meshes_) {
            for (Place& place : mesh.places) place.records = 0;
        }
        room = place_maps(scene);
    }
    if (too_much()) {
        throw Error(
            fmt::format("the maps of {} meshes with {} surfaces per texel and triangle are more than {} has room for",
                        meshes_.size(), room.records, device.info().name));
    }
    found_.set_capacity(std::max<std::uint64_t>(room.found, 1));
    make_room(texels_, device, "texels of the meshes' maps", room.texels * kMapTexelSize, kMapPairFormat);
    make_room(pyramid_, device, "pyramids of the meshes' maps", room.nodes * kMapNodeSize, kMapFormat);
    make_room(ranges_, device, "depths in the meshes' maps", room.records * kMapRangeSize, kMapFormat);
    make_room(records_, device, "surfaces in the meshes' maps", room.records * kMapRecordSize, kMapPairFormat);
    make_room(triangles_, device, "triangles of the meshes' maps", scene.indices.size() / 12 * kMapTriangleSize,
              kMapFormat);
    make_room(normals_, device, "normals of the meshes' maps", scene.indices.size() / 12 * kMapTriangleSize,
              kMapFormat);
    make_room(maps_, device, "meshes' maps", meshes_.size() * kAxes * sizeof(MapRecord));
    make_room(objects_, device, "mapped objects", scene.object_count * sizeof(MappedObject));
    laid_out_ = true;
}

std::vector<MapRecord> MeshMaps::write_tables(Recorder& recorder, const Frame& frame) {
    const GpuScene& scene = frame.scene;
    std::vector<MapRecord> records(meshes_.size() * kAxes);
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
        if (!meshes_[m].shown) continue;
        const MapBox box = box_of(scene.meshes[m], texels_across(scene.meshes[m]));
        for (std::uint32_t axis = 0; axis < kAxes; ++axis) {
            const Place& place = meshes_[m].places[axis];
            MapRecord record = record_along(axis, box);
            record.first_head = std::uint32_t(place.first_texel);
            record.first_node = std::uint32_t(place.first_node);
            record.first_triangle = scene.meshes[m].first_corner / 3;
            records[m * kAxes + axis] = record;
        }
    }
    std::vector<MappedObject> objects(scene.object_count);
    for (std::uint32_t i = 0; i < scene.object_count; ++i) {
        const std::uint32_t m = scene.mesh_of_object[i];
        const MapBox box = box_of(scene.meshes[m], texels_across(scene.meshes[m]));
        objects[i] = {box.low, m * kAxes, box.high, scene.meshes[m].first_corner / 3};
    }
    recorder.write(maps_, std::as_bytes(std::span(records)));
    recorder.write(objects_, std::as_bytes(std::span(objects)));
    return records;
}

SurfaceMap MeshMaps::bring_up_to_date(Recorder& recorder, const Frame& frame, std::uint32_t resolution) {
    const GpuScene& scene = frame.scene;
    if (resolution != resolution_ || meshes_.size() != scene.meshes.size()) {
        *this = MeshMaps();
        resolution_ = texels_across_ = resolution;
        meshes_.resize(scene.meshes.size());
        for (const std::uint32_t m : scene.mesh_of_object) meshes_[m].shown = true;
    }
    if (!laid_out_ || !fits(frame)) lay_out(frame);
    building_.clear();
    for (std::uint32_t m = 0; m < meshes_.size(); ++m) {
        const bool current = meshes_[m].built && meshes_[m].moves == scene.meshes[m].moves;
        if (meshes_[m].shown && scene.meshes[m].triangle_count > 0 && !current) building_.push_back(m);
    }
    if (building_.empty()) return buffers();
    const std::vector<MapRecord> records = write_tables(recorder, frame);
    const Recorder::Scope scope(recorder, "mesh maps");
    const SurfaceMap map = buffers();
    for (const std::uint32_t m : building_) {
        for (std::uint32_t axis = 0; axis < kAxes; ++axis) {
            Place& place = meshes_[m].places[axis];
            const std::uint32_t index = m * kAxes + axis;
            found_.begin(recorder, frame.workspace, 0);
            build_map(recorder, frame, *scene.topology,
                      {map, records[index], index, true, scene.meshes[m].triangle_count,
                       std::uint32_t(place.first_record), std::uint32_t(place.records), found_, tiles_,
                       [&place](std::uint32_t counted) { place.counted = counted; }});
        }
        meshes_[m].moves = scene.meshes[m].moves;
    }
    return map;
}

bool MeshMaps::must_repeat() {
    bool repeat = tiles_.grow();
    for (const std::uint32_t m : building_) {
        meshes_[m].built = true;
        for (Place& place : meshes_[m].places) {
            if (place.counted <= place.records) continue;
            // Allocate a quarter more, because the need of a deforming mesh varies from frame to frame.
            place.records = whole_range_blocks(place.counted + place.counted / 4);
            repeat = true;
        }
    }
    found_.grow();
    building_.clear();
    if (repeat) laid_out_ = false;
    return repeat;
}

}  // namespace pellucid
