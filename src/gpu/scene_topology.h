#pragma once

#include "gpu/memory.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// What techniques that follow rays through a scene's triangles know of it besides GpuScene.
struct SceneTopology {
    Buffer traits;             ///< per object, see object_traits.glsl
    Buffer materials;          ///< uint[]: per rank of a refracting object, its material; and kReplacedSolid
    Buffer boxes;              ///< ObjectBox[], see follow_paths.comp
    std::uint32_t solids = 0;  ///< refracting objects; each has a rank below this
    bool all_alone = true;     ///< no two objects' boxes meet, so no two surfaces lie at one place
    std::uint64_t moves = 0;   ///< GpuScene::moves that the traits are of

    SceneTopology(const Device& device, const Scene& scene);
    /// Where vertices have moved. Meshes that are closed stay so.
    void update(const Device& device, const Scene& scene, std::uint64_t moves);
    /// Marks objects for which volumes stand; all others are not. Techniques that draw no volumes look past the mark.
    void mark_replaced(const Device& device, const std::vector<int>& objects);

private:
    std::vector<std::uint32_t> trait_words_, material_words_;
    std::vector<bool> closed_;  ///< per mesh
};

}  // namespace pellucid
