#version 460
// Filters the environment for rough surfaces: the mean over the GGX reflection lobe, seen along the normal. Facets are
// sampled in proportion to their visible area (Walter et al. 2007). Each sample takes the mean over its solid angle, so
// that a small sun leaves no specks (Krivanek & Colbert, "Real-time shading with filtered importance sampling", 2008).
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/structs.h"
#include "gpu/environment_pyramid.glsl"
#include "gpu/filter_levels.glsl"
#include "gpu/octahedral_map.glsl"
#include "gpu/spread_points.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform texture2D pyramid;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2DArray filtered_environment;

const float kPi = 3.14159265;
const int kCoarsest = PELLUCID_PYRAMID_LEVELS - 1;

// Duff et al., "Building an orthonormal basis, revisited", JCGT 2017.
mat3 frame_around(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z), b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

vec3 mean_over_lobe(vec3 direction, float roughness, uint count) {
    float alpha = roughness * roughness, alpha2 = alpha * alpha;
    mat3 world_from_lobe = frame_around(direction);
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < count; ++i) {
        vec2 u = spread_point(i, count);
        float tan2 = alpha2 * u.x / (1.0 - u.x);  // of the facet's slope
        if (tan2 >= 1.0) break;                   // the light comes from below; slopes grow with i
        float cos2 = 1.0 / (1.0 + tan2), angle = 2.0 * kPi * u.y;
        float cos_light = 2.0 * cos2 - 1.0, sin_light = sqrt(max(1.0 - cos_light * cos_light, 0.0));
        vec3 light = world_from_lobe * vec3(sin_light * cos(angle), sin_light * sin(angle), cos_light);
        float spread = cos2 * (tan2 + alpha2);
        float density = alpha2 / (4.0 * kPi * spread * spread);  // of `light`, per steradian
        vec3 point = light / (abs(light.x) + abs(light.y) + abs(light.z));
        float texels = 1.0 / (float(count) * density * octahedral_texel_solid_angle(point, kPyramidSize));
        // Use a level that is half a level coarser, so that samples overlap.
        int level = clamp(int(0.5 * log2(texels) + 1.0), 0, kCoarsest);
        // Smith's masking: share of the light that other facets do not shadow.
        float shadowing = 2.0 / (1.0 + sqrt(1.0 + alpha2 * (1.0 / (cos_light * cos_light) - 1.0)));
        vec3 radiance = octahedral_map_value(pyramid, pyramid_corner(level), pyramid_size(level), light).rgb;
        sum += shadowing * vec4(radiance, 1.0);
    }
    return sum.rgb / sum.a;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    for (int level = 1; level <= PELLUCID_FILTER_LEVELS; ++level) {
        ivec2 texel = at - filter_level_corner(level);
        int size = filter_level_size(level);
        if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(size)))) continue;
        vec3 direction = normalize(octahedron_point((2.0 * vec2(texel) + 1.0) / float(size) - 1.0));
        uint count = min(32u << uint(level), 1024u);  // wider lobes need more samples and have fewer texels
        float roughness = float(level) / float(PELLUCID_FILTER_LEVELS);
        imageStore(filtered_environment, ivec3(at, 0), vec4(mean_over_lobe(direction, roughness, count), 1.0));
        return;
    }
}
