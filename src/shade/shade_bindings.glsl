#ifndef PELLUCID_SHADE_SHADE_BINDINGS_GLSL
#define PELLUCID_SHADE_SHADE_BINDINGS_GLSL

// Shared by shade.comp and background.comp. Programs are specialised for the content of the scene.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"

layout(constant_id = 0) const uint kEnvironmentKind = 0u;
layout(constant_id = 1) const bool kAnalysis = false;   // View::kAnalysis
layout(constant_id = 2) const bool kThinWalls = false;  // the scene has thin-walled objects
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

// Radiance of the environment and of directional lights in a direction.
vec3 radiance_from_afar(vec3 direction) { return environment_radiance(direction) + suns_ahead(direction); }

// Replaces `seen` by a sized lamp in front of it. `depth`: of `seen` along the view axis, m.
void see_lamps(ivec2 texel, float depth, inout vec3 seen) {
    if (kVisibleLights == 0u) return;
    Ray ray = camera_ray(vec2(texel) + 0.5);
    vec3 lamp, origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    float limit = depth / -ray.direction.z;
    if (lamp_ahead(origin, world_view_direction(texel), limit, lamp) < limit) seen = drawn(PELLUCID_EMITTED, lamp);
}

// Stores the radiance seen at a pixel, through the thin walls in front.
void store_radiance(ivec2 texel, vec3 seen) {
    ivec3 at = ivec3(texel, 0);
    if (kThinWalls && !kAnalysis) {
        vec3 reflected = min(imageLoad(thin_reflection, at).rgb, vec3(65504.0));  // sums of panes are 16-bit floats
        seen = seen * imageLoad(thin_tint, at).rgb + reflected;
    }
    imageStore(radiance, at, vec4(seen, 1.0));
}

#endif
