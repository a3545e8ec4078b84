#version 460
// Radiance of every pixel from its refraction.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"
#include "layers/layers.glsl"
#include "optics/interface.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 3) uniform texture2D environment_map;
layout(set = 0, binding = 4, rgba32f) readonly uniform image2DArray opaque_radiance;
layout(set = 0, binding = 5, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 6, rg32ui) readonly uniform uimage2DArray layer_surface;
layout(set = 0, binding = 7, rgba16f) readonly uniform image2DArray glass_tint;
layout(set = 0, binding = 8, rgba16f) readonly uniform image2DArray thin_tint;
layout(set = 0, binding = 9, rgba16f) readonly uniform image2DArray thin_reflection;
layout(set = 0, binding = 10, rgba32f) readonly uniform image2DArray exit_direction;
layout(set = 0, binding = 11, rgba32f) readonly uniform image2DArray transmittance;
layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray path_events;
layout(set = 0, binding = 13, rgba32f) writeonly uniform image2DArray radiance;
layout(push_constant) uniform Push { uint analysis; };

#include "layers/objects.glsl"
#include "shade/diffuse.glsl"
#include "shade/environment_lookup.glsl"

// Glass in front of `behind`, the radiance that reaches the end of its refracted path.
vec3 glass_radiance(ivec3 at, vec3 view_direction, uvec2 first, vec3 behind) {
    uint object = find_object(triangle_index(first.y));
    MaterialRecord material = materials[objects[object].material];
    vec4 tint = vec4(material.base_color.rgb, material.transmission) * imageLoad(glass_tint, at);
    vec3 transmitted = imageLoad(transmittance, at).rgb * behind;
    vec3 normal = unpack_unit_vector(first.x);
    if (back_face(first.y)) return tint.rgb * transmitted;  // seen from inside: no outer reflection
    float reflectance = fresnel_dielectric(-dot(view_direction, normal), 1.0 / material.ior);
    vec3 reflected = reflectance * environment_radiance(reflect_direction(view_direction, normal));
    vec3 scattered = (1.0 - reflectance) * diffuse_radiance(tint.rgb, normal);
    return reflected + mix(scattered, tint.rgb * transmitted, tint.a);
}

// Wang 2014, figure 4.5: red up to two interfaces, blue more, green total internal reflection.
vec3 analysis_color(ivec3 at, vec3 view_direction, vec3 normal) {
    uint events = imageLoad(path_events, at).r;  // twin of unpack_events()
    vec3 color = vec3(0.85, 0.1, 0.08);
    if ((events & 0xfffu) > 2u) color = vec3(0.1, 0.2, 0.9);
    if (((events >> 12) & 0xfffu) > 0u) color = vec3(0.1, 0.7, 0.15);
    if (((events >> 24) & 0xfu) != 0u) color = vec3(0.35);  // the technique gave up
    return color * (0.4 + 0.6 * abs(dot(view_direction, normal)));
}

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (at.x >= int(frame.width) || at.y >= int(frame.height)) return;

    vec3 view_direction = mat3(frame.world_from_view) * camera_ray(vec2(at.xy) + 0.5).direction;
    uvec2 first = imageLoad(layer_surface, at).rg;
    bool glass = first.y != PELLUCID_NO_TRIANGLE;
    bool opaque = imageLoad(opaque_depth, at).r < PELLUCID_EMPTY_DEPTH;
    vec3 result;
    if (analysis != 0u) {
        result = glass ? analysis_color(at, view_direction, unpack_unit_vector(first.x)) : vec3(0.02);
    } else {
        // Without glass the path is the view ray itself, so one look-up serves both.
        result = environment_radiance(imageLoad(exit_direction, at).xyz);
        if (glass) result = glass_radiance(at, view_direction, first, result);
        else if (opaque) result = imageLoad(opaque_radiance, at).rgb;
        result = result * imageLoad(thin_tint, at).rgb +
                 min(imageLoad(thin_reflection, at).rgb, vec3(65504.0));  // panes add up in 16-bit float
    }
    imageStore(radiance, at, vec4(result, 1.0));
}
