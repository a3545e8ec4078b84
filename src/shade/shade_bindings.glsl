#ifndef PELLUCID_SHADE_SHADE_BINDINGS_GLSL
#define PELLUCID_SHADE_SHADE_BINDINGS_GLSL

// What shade.comp and background.comp share. Programs are made for what there is in the scene.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"

layout(constant_id = 0) const uint kEnvironmentKind = 0u;
layout(constant_id = 1) const bool kAnalysis = false;    // View::kAnalysis
layout(constant_id = 2) const bool kThinWalls = false;   // there are thin-walled objects
#define PELLUCID_ENVIRONMENT_KIND kEnvironmentKind

layout(set = 0, binding = 1) uniform texture2D environment_map;
layout(set = 0, binding = 2, rgba16f) readonly uniform image2DArray thin_tint;
layout(set = 0, binding = 3, rgba16f) readonly uniform image2DArray thin_reflection;
layout(set = 0, binding = 4, rgba32f) writeonly uniform image2DArray radiance;

#include "gpu/environment_lookup.glsl"
#include "gpu/background.glsl"
#include "gpu/light_parts.glsl"
#include "gpu/punctual_light.glsl"
layout(constant_id = 6) const uint kVisibleLights = 0u;
layout(std430, set = 0, binding = 17) readonly buffer SceneLights { PunctualLight scene_lights[]; };
#include "gpu/visible_lights.glsl"

vec3 world_view_direction(ivec2 texel) {
    return mat3(frame.world_from_view) * camera_ray(vec2(texel) + 0.5).direction;
}

// Of the environment and of suns, in a direction.
vec3 radiance_from_afar(vec3 direction) { return environment_radiance(direction) + suns_ahead(direction); }

// A lamp of some size takes the place of what is seen behind it, at a depth along the view's axis, m.
void see_lamps(ivec2 texel, float depth, inout vec3 seen) {
    if (kVisibleLights == 0u) return;
    Ray ray = camera_ray(vec2(texel) + 0.5);
    vec3 lamp, origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    float limit = depth / -ray.direction.z;
    if (lamp_ahead(origin, world_view_direction(texel), limit, lamp) < limit) seen = drawn(PELLUCID_EMITTED, lamp);
}

// Stores what is seen at a pixel behind the thin walls in front of it.
void store_radiance(ivec2 texel, vec3 seen) {
    ivec3 at = ivec3(texel, 0);
    if (kThinWalls && !kAnalysis) {
        vec3 reflected = min(imageLoad(thin_reflection, at).rgb, vec3(65504.0));  // panes add up in 16-bit float
        seen = seen * imageLoad(thin_tint, at).rgb + reflected;
    }
    imageStore(radiance, at, vec4(seen, 1.0));
}

#endif
