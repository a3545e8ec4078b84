#pragma once

#include "gpu/acceleration_structure.h"
#include "gpu/gpu_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace pellucid {

/// Hierarchy over a scene's triangles: one structure per mesh, and one over their placements. The custom index of an
/// instance is its object.
class SceneHierarchy {
public:
    /// Nothing is built yet. The scene's vertices must stay where they are. Needs Device::ray_tracing().
    SceneHierarchy(const Device& device, const GpuScene& scene, StructureUse use);
    SceneHierarchy(const SceneHierarchy&) = delete;
    SceneHierarchy& operator=(const SceneHierarchy&) = delete;

    /// True if it is the hierarchy of `scene` made for `use`, or becomes that in update().
    bool is_of(const GpuScene& scene, StructureUse use) const;

    /// Records, in a scope of its own, what a frame needs before it can trace: the first time the build ("build"), and
    /// where vertices have moved since, or `always`, what the use asks for ("refit" or "build").
    void update(Recorder& recorder, const GpuScene& scene, bool always);

    const AccelerationStructure& top() const { return *top_; }

private:
    void write_instances(Recorder& recorder, const GpuScene& scene) const;
    void record(Recorder& recorder, vk::BuildAccelerationStructureModeKHR mode, const std::vector<bool>& meshes) const;

    StructureUse use_;
    ResourceId vertices_;
    std::uint64_t moves_ = 0;                    ///< GpuScene::moves that it is of
    std::vector<AccelerationStructure> meshes_;  ///< as GpuScene::meshes
    Buffer instances_;
    std::optional<AccelerationStructure> top_;
    std::optional<BuildScratch> scratch_;  // none once a static hierarchy is built
    bool built_ = false;
    std::shared_ptr<int> alive_ = std::make_shared<int>(0);  ///< gone with it, which frames that run may outlive
};

}  // namespace pellucid
