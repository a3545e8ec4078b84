#pragma once

#include "gpu/acceleration_structure.h"
#include "gpu/gpu_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace pellucid {

/// Hierarchy over a scene's triangles: one structure per mesh, and one over all instances of meshes. The custom index
/// of an instance is its object.
class SceneHierarchy {
public:
    /// Allocates the hierarchy; update() builds it. The scene's vertex buffer must stay the same. Needs
    /// Device::ray_tracing().
    SceneHierarchy(const Device& device, const GpuScene& scene, StructureUse use);
    SceneHierarchy(const SceneHierarchy&) = delete;
    SceneHierarchy& operator=(const SceneHierarchy&) = delete;

    /// True if this is the hierarchy of `scene` for `use`, possibly not built yet.
    bool is_of(const GpuScene& scene, StructureUse use) const;

    /// Records the update that a frame needs before it can trace, in its own scope. The first update builds ("build").
    /// Later updates refit or rebuild, depending on the use ("refit" or "build"). They do so only if vertices have
    /// moved or `always` is true.
    void update(Recorder& recorder, const GpuScene& scene, bool always);

    const AccelerationStructure& top() const { return *top_; }

private:
    void write_instances(Recorder& recorder, const GpuScene& scene) const;
    void record(Recorder& recorder, vk::BuildAccelerationStructureModeKHR mode, const std::vector<bool>& meshes) const;

    StructureUse use_;
    ResourceId vertices_;
    std::uint64_t moves_ = 0;                    ///< GpuScene::moves at the last update that has run
    std::vector<AccelerationStructure> meshes_;  ///< one per element of GpuScene::meshes
    Buffer instances_;
    std::optional<AccelerationStructure> top_;
    std::optional<BuildScratch> scratch_;  // none once a static hierarchy is built
    bool built_ = false;
    std::shared_ptr<int> alive_ =
        std::make_shared<int>(0);  ///< expires with this object, which running frames may outlive
};

}  // namespace pellucid
