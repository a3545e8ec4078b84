#version 460
// Radiance of every pixel as if there were no refracting glass; shade.comp then draws the pixels that have some.
#extension GL_GOOGLE_include_directive : require
#include "shade/shade_bindings.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 3) const bool kOpaque = false;  // there are opaque objects

layout(set = 0, binding = 5, rgba32f) readonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 6, r32f) readonly uniform image2DArray opaque_depth;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (at.x >= int(frame.width) || at.y >= int(frame.height)) return;
    if (kAnalysis) {
        store_radiance(at.xy, vec3(0.02));
        return;
    }
    Ray ray = camera_ray(vec2(at.xy) + 0.5);
    vec3 direction = mat3(frame.world_from_view) * ray.direction, seen = radiance_from_afar(direction);
    float opaque = kOpaque ? imageLoad(opaque_depth, at).r : PELLUCID_EMPTY_DEPTH;
    if (opaque < PELLUCID_EMPTY_DEPTH) seen = imageLoad(opaque_radiance, at).rgb;
    if (kVisibleLights > 0u) {
        vec3 lamp, origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
        float limit = opaque / -ray.direction.z;
        if (lamp_ahead(origin, direction, limit, lamp) < limit) seen = lamp;
    }
    store_radiance(at.xy, seen);
}
