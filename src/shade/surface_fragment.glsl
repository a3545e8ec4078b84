#ifndef PELLUCID_SHADE_SURFACE_FRAGMENT_GLSL
#define PELLUCID_SHADE_SURFACE_FRAGMENT_GLSL

// Shared by the fragment shaders of surface.vert: the material with its textures.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "gpu/frame.glsl"
#include "gpu/fragment_depth.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = 3) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 4) uniform texture2DArray texture_pages;
#include "gpu/texture.glsl"

layout(location = 0) in vec3 world_normal;
layout(location = 1) in vec4 texcoords;
layout(location = 2) in vec4 vertex_color;
layout(location = 3) flat in uint material_index;
layout(location = 4) flat in uint triangle;

vec4 base_color(MaterialRecord material) {
    return material.base_color * vertex_color * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw);
}

float transmission(MaterialRecord material) {
    return material.transmission * sample_texture(material.transmission_texture, texcoords.xy, texcoords.zw).r;
}

// World-space view ray, and the interpolated normal on the side that the ray comes from.
vec3 world_view_direction() {
    return mat3(frame.world_from_view) * camera_ray(gl_FragCoord.xy).direction;
}

vec3 facing_normal(vec3 view_direction) {
    return faceforward(normalize(world_normal), view_direction, normalize(world_normal));
}

#endif
