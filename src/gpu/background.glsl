#ifndef PELLUCID_GPU_BACKGROUND_GLSL
#define PELLUCID_GPU_BACKGROUND_GLSL

// The caller's background as rays see it. It is known only where the image shows it, and replaces the environment
// there. Needs: gpu/frame.glsl.
layout(constant_id = 47) const bool kBackground = false;
layout(set = 0, binding = 61) uniform texture2D background_radiance;
layout(set = 0, binding = 62) uniform texture2D background_depth;  // m along the view's axis; PELLUCID_EMPTY_DEPTH: sky

float stored_depth(ivec2 texel) { return texelFetch(background_depth, texel, 0).r; }
#include "gpu/depth_search.glsl"

const uint kBackgroundSteps = 64u, kBackgroundHalvings = 6u;

vec3 background_at(ivec2 texel) { return texelFetch(background_radiance, texel, 0).rgb; }

// Whether a ray meets the caller's background or reaches the caller's sky, as far as the image shows them. `position`
// and `direction` are in world space.
bool background_ahead(vec3 position, vec3 direction, out vec3 radiance) {
    radiance = vec3(0.0);
    vec3 from = (frame.view_from_world * vec4(position, 1.0)).xyz;
    vec3 way = mat3(frame.view_from_world) * direction;
    if (-from.z < frame.near_plane) return false;  // the image shows nothing behind the eye
    // Limit the ray to a distance beyond which its pixel does not change. Towards the eye it ends at the near plane.
    float far = 1e4 * (frame.glass_far - from.z);
    float t = way.z > 0.0 ? min(far, max(-from.z - frame.near_plane, 0.0) / way.z) : far;
    Stretch s = stretch_of(from, from + t * way);
    float end = share_within_picture(s);
    if (end < 0.0) return false;
    bool behind = is_behind(s, 0.0);
    float share = search(s, kBackgroundSteps, kBackgroundHalvings, behind);
    ivec2 texel = texel_at(s, share >= 0.0 ? share : 1.0);
    bool sees_sky = end == 1.0 && way.z < 0.0 && stored_depth(texel) == PELLUCID_EMPTY_DEPTH;
    if (share < 0.0 && !sees_sky) return false;
    radiance = background_at(texel);
    return true;
}

#endif
