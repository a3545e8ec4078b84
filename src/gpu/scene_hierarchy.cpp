#include "gpu/scene_hierarchy.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace pellucid {
namespace {

using Mode = vk::BuildAccelerationStructureModeKHR;

constexpr std::uint32_t kMaxCustomIndex = 0xffffffu;  // 24 bits

vk::TransformMatrixKHR transform_rows(const glm::mat4& m) {
    vk::TransformMatrixKHR rows;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) rows.matrix[row][column] = m[column][row];
    }
    return rows;
}

}  // namespace

SceneHierarchy::SceneHierarchy(const Device& device, const GpuScene& scene, StructureUse use)
    : use_(use), vertices_(scene.vertices.id()), moves_(scene.moves) {
    if (scene.object_count > kMaxCustomIndex) {
        throw Error(fmt::format("{} objects: ray tracing numbers at most {}", scene.object_count, kMaxCustomIndex));
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, vk::DeviceAddress> known;  // mesh by its triangles -> structure
    std::vector<vk::AccelerationStructureInstanceKHR> instances;
    for (const DrawCall& object : scene.refractive) {
        const auto [mesh, is_new] = known.try_emplace({object.first_corner, object.corner_count}, 0);
        if (is_new) {
            const AccelerationStructure::Triangles triangles{
                .vertices = scene.vertices.address(),
                .stride = kVertexStride,
                .vertex_count = scene.vertex_count,
                .indices = scene.indices.address() + vk::DeviceSize(object.first_corner) * sizeof(std::uint32_t),
                .corner_count = object.corner_count};
            meshes_.emplace_back(device, "a mesh's acceleration structure", triangles, use);
            mesh->second = meshes_.back().address();
        }
        // Without flags the front is where triangles run counter-clockwise in a right-handed frame. That is
        // decided in the mesh's own frame, so a mirroring transform changes nothing.
        instances.push_back({.transform = transform_rows(scene.world_from_object[object.object]),
                             .instanceCustomIndex = object.object,
                             .mask = 0xff,
                             .instanceShaderBindingTableRecordOffset = 0,
                             .flags = 0,
                             .accelerationStructureReference = mesh->second});
    }
    instances_ = Buffer(device, "instances of acceleration structures", instances.size() * sizeof(instances[0]),
                        vk::BufferUsageFlagBits::eAccelerationStructureBuildInputReadOnlyKHR |
                            vk::BufferUsageFlagBits::eShaderDeviceAddress,
                        true);
    std::ranges::copy(std::as_bytes(std::span(instances)), instances_.mapped());
    top_.emplace(device, "the scene's acceleration structure",
                 AccelerationStructure::Instances{instances_.address(), std::uint32_t(instances.size())}, use);
    vk::DeviceSize scratch = top_->scratch_size();
    for (const AccelerationStructure& mesh : meshes_) scratch = std::max(scratch, mesh.scratch_size());
    scratch_.emplace(device, scratch);
}

bool SceneHierarchy::is_of(const GpuScene& scene, StructureUse use) const {
    const bool follows = use_ != StructureUse::kStatic || moves_ == scene.moves;
    return scene.vertices.id() == vertices_ && use == use_ && follows;
}

void SceneHierarchy::update(Recorder& recorder) {
    if (built_ && use_ == StructureUse::kStatic) return;
    const bool refit = built_ && use_ == StructureUse::kRefit;
    const Recorder::Scope scope(recorder, refit ? "refit" : "build");
    record(recorder, refit ? Mode::eUpdate : Mode::eBuild);
    recorder.when_done([this] {
        built_ = true;
        if (use_ == StructureUse::kStatic) scratch_.reset();
    });
}

// One after the other: they share the scratch memory, which for a large mesh is as large as the mesh.
void SceneHierarchy::record(Recorder& recorder, Mode mode) const {
    std::vector<ResourceId> parts = {instances_.id()};
    for (const AccelerationStructure& mesh : meshes_) {
        recorder.build(mesh, mode, std::span(&vertices_, 1), *scratch_);
        parts.push_back(mesh.id());
    }
    recorder.build(*top_, mode, parts, *scratch_);
}

}  // namespace pellucid
