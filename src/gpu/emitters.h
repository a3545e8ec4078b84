#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// A triangle that emits light, and its sampling probability; twin of EmitterRecord in emitters.glsl.
struct EmitterRecord {
    std::uint32_t object;
    std::uint32_t triangle;  ///< over all objects
    float cumulative;        ///< probability of this triangle and all earlier ones together, 0..1
    float density;           ///< of sampled points, 1/m2
};
static_assert(sizeof(EmitterRecord) == 16);

/// Whether emitters_of() lists objects of that material.
bool emits_light(const Material& material);

/// Lists the triangles of opaque objects with an emissive material, in the order of the scene. Probabilities are
/// proportional to area times the sum of the emission's channels; textures count as white. `first_triangles`: per
/// object. Empty if nothing emits.
std::vector<EmitterRecord> emitters_of(const Scene& scene, std::span<const std::uint32_t> first_triangles);

}  // namespace pellucid
