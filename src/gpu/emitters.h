#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// A triangle that emits light, and with which probability it is sampled; twin of EmitterRecord in emitters.glsl.
struct EmitterRecord {
    std::uint32_t object;
    std::uint32_t triangle;  ///< over all objects
    float cumulative;        ///< probability, 0..1, of this triangle and those before it
    float density;           ///< of sampled points, 1/m2
};
static_assert(sizeof(EmitterRecord) == 16);

/// Whether an object of that material is among emitters_of().
bool emits_light(const Material& material);

/// The triangles of opaque objects whose material emits, in order, by area times the mean of the emission's channels; textures
/// count as white. `first_triangles`: per object. Empty if nothing emits.
std::vector<EmitterRecord> emitters_of(const Scene& scene, std::span<const std::uint32_t> first_triangles);

}  // namespace pellucid
