#pragma once

#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// A view from a light: of all its targets, or a face of a cube around it.
struct LightView {
    static constexpr std::uint32_t kWhole = 6;
    gpu::FrameConstants constants;  ///< camera part
    std::uint32_t light;            ///< Scene::lights
    std::uint32_t face = kWhole;    ///< +x, -x, +y, -y, +z, -z, or kWhole
    float target_depth = 0.0f;      ///< m, of the middle of the targets
};

/// What light number `number` looks at to see every target, `resolution` texels along a side: one view around them; or,
/// where a point or spot light is so near that they would fill more than 120 degrees of it, the faces of a cube that any of
/// them may lie in. `targets`: corners of the targets' boxes, world, m. `bounds`: of all that may stand in the light.
std::vector<LightView> light_views(const Light& light, std::uint32_t number, std::span<const glm::vec3> targets,
                                   const Bounds& bounds, std::uint32_t resolution);

}  // namespace pellucid
