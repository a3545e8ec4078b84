#pragma once

#include "gpu/structs.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// A view from a light: a view of all its targets, or a face of a cube around the light.
struct LightView {
    static constexpr std::uint32_t kWhole = 6;
    gpu::FrameConstants constants;  ///< camera part
    std::uint32_t light;            ///< Scene::lights
    std::uint32_t face = kWhole;    ///< +x, -x, +y, -y, +z, -z, or kWhole
    float target_depth = 0.0f;      ///< depth of the targets' centre, m
};

/// The views from which light number `number` sees every target, `resolution` texels along a side. One view suffices if
/// all targets lie within 120 degrees. Nearer point and spot lights get the faces of a cube in which targets may lie.
/// `targets`: corners of the targets' boxes, world, m. `bounds`: bounds of all objects that may block the light.
std::vector<LightView> light_views(const Light& light, std::uint32_t number, std::span<const glm::vec3> targets,
                                   const Bounds& bounds, std::uint32_t resolution);

}  // namespace pellucid
