#version 460
// Radiance of the pixels with refracting glass, from its refraction.
#extension GL_GOOGLE_include_directive : require
#include "shade/shade_bindings.glsl"
#include "layers/layers.glsl"
#include "layers/pixel_list.glsl"
#include "optics/interface.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(constant_id = 3) const bool kTextured = false;      // some glass varies in colour or transmission
layout(constant_id = 4) const bool kPathRadiance = false;  // paths pick up radiance
layout(constant_id = 5) const bool kReflected = false;     // and what the first surface reflects

layout(std430, set = 0, binding = 5) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 6) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 7, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 8, r32ui) readonly uniform uimage2DArray layer_normal;
layout(set = 0, binding = 9, rgba16f) readonly uniform image2DArray glass_tint;
layout(set = 0, binding = 10, rgba32f) readonly uniform image2DArray exit_direction;
layout(set = 0, binding = 11, rgba32f) readonly uniform image2DArray transmittance;
layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray path_events;
layout(set = 0, binding = 13, rgba32f) readonly uniform image2DArray path_radiance;
layout(set = 0, binding = 14, rgba32f) readonly uniform image2DArray reflected_radiance;

#include "layers/objects.glsl"
#include "gpu/diffuse.glsl"
#include "shade/analysis_color.glsl"

// What comes through the glass: the end of the refracted path, and what it picked up on the way.
vec3 transmitted_radiance(ivec3 at) {
    vec3 behind = imageLoad(transmittance, at).rgb * environment_radiance(imageLoad(exit_direction, at).xyz);
    if (!kPathRadiance) return behind;
    vec4 picked_up = imageLoad(path_radiance, at);
    return behind * (1.0 - picked_up.a) + picked_up.rgb;
}

vec3 glass_radiance(ivec3 at, vec3 view_direction, vec3 normal, uint triangle) {
    MaterialRecord material = materials[objects[find_object(triangle_index(triangle))].material];
    vec4 tint = vec4(material.base_color.rgb, material.transmission);
    if (kTextured) tint *= imageLoad(glass_tint, at);
    vec3 transmitted = transmitted_radiance(at);
    if (back_face(triangle)) return tint.rgb * transmitted;  // seen from inside: no outer reflection
    float reflectance = fresnel_dielectric(-dot(view_direction, normal), 1.0 / material.ior);
    vec3 reflected = kReflected ? imageLoad(reflected_radiance, at).rgb
                                : reflectance * environment_radiance(reflect_direction(view_direction, normal));
    vec3 scattered = (1.0 - reflectance) * diffuse_radiance(tint.rgb, normal);
    return reflected + mix(scattered, tint.rgb * transmitted, tint.a);
}

vec3 shaded_analysis_color(ivec3 at, vec3 view_direction, vec3 normal) {
    return analysis_color(imageLoad(path_events, at).r) * (0.4 + 0.6 * abs(dot(view_direction, normal)));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    ivec3 at = ivec3(texel, 0);
    vec3 view_direction = world_view_direction(texel);
    vec3 normal = unpack_unit_vector(imageLoad(layer_normal, at).r);
    store_radiance(texel, kAnalysis ? shaded_analysis_color(at, view_direction, normal)
                                    : glass_radiance(at, view_direction, normal, imageLoad(layer_triangle, at).r));
}
