#include "gpu/scene_hierarchy.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <span>

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
    : use_(use), vertices_(scene.vertices.id()) {
    if (scene.object_count > kMaxCustomIndex) {
        throw Error(fmt::format("{} objects: ray tracing numbers at most {}", scene.object_count, kMaxCustomIndex));
    }
    for (const GpuMesh& mesh : scene.meshes) {
        const AccelerationStructure::Triangles triangles{
            .vertices = scene.vertices.address(),
            .stride = kVertexStride,
            .vertex_count = scene.vertex_count,
            .indices = scene.indices.address() + vk::DeviceSize(mesh.first_corner) * sizeof(std::uint32_t),
            .corner_count = 3 * mesh.triangle_count};
        meshes_.emplace_back(device, "a mesh's acceleration structure", triangles, use);
    }
    using Instance = vk::AccelerationStructureInstanceKHR;
    instances_ = Buffer(device, "instances of acceleration structures", scene.object_count * sizeof(Instance),
                        vk::BufferUsageFlagBits::eAccelerationStructureBuildInputReadOnlyKHR |
                            vk::BufferUsageFlagBits::eShaderDeviceAddress | vk::BufferUsageFlagBits::eTransferDst);
    top_.emplace(device, "the scene's acceleration structure",
                 AccelerationStructure::Instances{instances_.address(), scene.object_count}, use);
    vk::DeviceSize scratch = top_->scratch_size();
    for (const AccelerationStructure& mesh : meshes_) scratch = std::max(scratch, mesh.scratch_size());
    scratch_.emplace(device, scratch);
}

bool SceneHierarchy::is_of(const GpuScene& scene, StructureUse use) const {
    return scene.vertices.id() == vertices_ && use == use_;
}

void SceneHierarchy::update(Recorder& recorder, const GpuScene& scene, bool always) {
    if (built_ && !always && scene.moves == moves_) return;
    const bool refit = built_ && use_ == StructureUse::kRefit;
    std::vector<bool> changed;
    for (const GpuMesh& mesh : scene.meshes) changed.push_back(!built_ || always || mesh.moves > moves_);
    const Recorder::Scope scope(recorder, refit ? "refit" : "build");
    write_instances(recorder, scene);
    record(recorder, refit ? Mode::eUpdate : Mode::eBuild, changed);
    recorder.when_done([this, moves = scene.moves, alive = std::weak_ptr<int>(alive_)] {
        if (alive.expired()) return;
        built_ = true;
        moves_ = moves;
        if (use_ == StructureUse::kStatic) scratch_.reset();
    });
}

void SceneHierarchy::write_instances(Recorder& recorder, const GpuScene& scene) const {
    std::vector<vk::AccelerationStructureInstanceKHR> instances;
    for (std::uint32_t object = 0; object < scene.object_count; ++object) {
        instances.push_back({.transform = transform_rows(scene.world_from_object[object]),
                             .instanceCustomIndex = object,
                             .mask = 0xff,
                             .instanceShaderBindingTableRecordOffset = 0,
                             .flags = 0,
                             .accelerationStructureReference = meshes_[scene.mesh_of_object[object]].address()});
    }
    recorder.write(instances_, std::as_bytes(std::span(instances)));
}

// Builds run one after the other, because they share scratch memory. For a large mesh that is as large as the mesh.
void SceneHierarchy::record(Recorder& recorder, Mode mode, const std::vector<bool>& meshes) const {
    std::vector<ResourceId> parts = {instances_.id()};
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        if (meshes[i]) recorder.build(meshes_[i], mode, std::span(&vertices_, 1), *scratch_);
        parts.push_back(meshes_[i].id());
    }
    recorder.build(*top_, mode, parts, *scratch_);
}

}  // namespace pellucid
