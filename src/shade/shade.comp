#version 460
// Radiance of the pixels with refracting glass, from its refraction.
#extension GL_GOOGLE_include_directive : require
#include "shade/shade_bindings.glsl"
#include "layers/layers.glsl"
#include "layers/pixel_list.glsl"
#include "optics/interface.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(constant_id = 3) const bool kTextured = false;      // some glass varies in colour or transmission
layout(constant_id = 4) const bool kPathRadiance = false;  // paths gather radiance
layout(constant_id = 5) const bool kReflected = false;     // the technique supplies the reflection at the first surface
// that reflection contains lights only; rough glass reflects the environment besides
layout(constant_id = 8) const bool kHighlights = false;
layout(constant_id = 9) const uint kFootprint = 0u;  // samples along a side of the environment's footprint; 0: none

layout(std430, set = 0, binding = 5) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 6) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 7, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 18, r32f) readonly uniform image2DArray layer_depth;
layout(set = 0, binding = 8, r32ui) readonly uniform uimage2DArray layer_normal;
layout(set = 0, binding = 9) uniform texture2DArray texture_pages;
layout(set = 0, binding = 10, rgba32f) readonly uniform image2DArray exit_direction;
layout(set = 0, binding = 22, rgba32f) readonly uniform image2DArray exit_position;
layout(set = 0, binding = 11, rgba32f) readonly uniform image2DArray transmittance;
layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray path_events;
layout(set = 0, binding = 13, rgba32f) readonly uniform image2DArray path_radiance;
layout(set = 0, binding = 14, rgba32f) readonly uniform image2DArray reflected_radiance;

layout(std430, set = 0, binding = 15) readonly buffer Appearance { float appearance[]; };
layout(std430, set = 0, binding = 16) readonly buffer Textures { TextureRecord textures[]; };

#include "gpu/appearance.glsl"
#include "gpu/vertices.glsl"
#include "gpu/texture.glsl"
#include "layers/corner_weights.glsl"
#include "layers/objects.glsl"
#include "gpu/diffuse.glsl"
#include "shade/analysis_color.glsl"
#include "shade/exit_footprint.glsl"

vec3 light_from_afar(vec3 position, vec3 direction, bool with_suns) {
    vec3 seen;
    if (kBackground && background_ahead(position, direction, seen)) return seen;
    return with_suns ? radiance_from_afar(direction) : environment_radiance(direction);
}

// Light through the glass: from the end of the refracted path, and gathered along it. Rough glass scatters the light
// at both surfaces.
vec3 transmitted_radiance(ivec3 at, bool rough) {
    vec4 passes = imageLoad(transmittance, at);
    vec3 behind = passes.rgb;
    if (kFootprint > 0u) behind *= environment_over_footprint(at, kFootprint);
    else behind *= light_from_afar(imageLoad(exit_position, at).xyz, imageLoad(exit_direction, at).xyz, !kHighlights || passes.a > 0.0);
    behind = drawn(rough ? PELLUCID_INDIRECT : PELLUCID_EMITTED, behind);
    if (!kPathRadiance) return behind;
    vec4 picked_up = imageLoad(path_radiance, at);
    return behind * (1.0 - picked_up.a) + picked_up.rgb;
}

// Factors of base colour (rgb) and transmission (a) by the textures at the pixel's centre.
vec4 texture_tint(ivec3 at, uint triangle, ObjectRecord object) {
    uint corner = object.first_corner + 3u * (triangle - object.first_triangle);
    Ray ray = camera_ray(vec2(at.xy) + 0.5);
    vec3 v[3];
    vec4 texcoords[3], colors[3];
    for (uint k = 0u; k < 3u; ++k) {
        uint vertex = indices[corner + k];
        v[k] = (frame.view_from_world * (object.world_from_object * vec4(vertex_position(vertex), 1.0))).xyz;
        texcoords[k] = vertex_texcoords(vertex);
        colors[k] = vertex_color_of(vertex);
    }
    vec3 w = corner_weights(ray.direction, v[0] - ray.origin, v[1] - v[0], v[2] - v[0]);
    vec4 uv = w.x * texcoords[0] + w.y * texcoords[1] + w.z * texcoords[2];
    vec4 color = w.x * colors[0] + w.y * colors[1] + w.z * colors[2];
    MaterialRecord material = materials[object.material];
    return vec4(color.rgb * sample_texture(material.base_color_texture, uv.xy, uv.zw).rgb,
                sample_texture(material.transmission_texture, uv.xy, uv.zw).r);
}

vec3 glass_radiance(ivec3 at, vec3 view_direction, vec3 normal, uint triangle) {
    ObjectRecord object = objects[find_object(triangle_index(triangle))];
    MaterialRecord material = materials[object.material];
    vec4 tint = vec4(material.base_color.rgb, material.transmission);
    if (kTextured) tint *= texture_tint(at, triangle_index(triangle), object);
    bool rough = material.roughness > 0.0;
    vec3 transmitted = transmitted_radiance(at, rough);
    if (back_face(triangle)) {  // seen from inside: only paths from the eye have an outer reflection
        vec3 before = kReflected ? imageLoad(reflected_radiance, at).rgb : vec3(0.0);
        return before + tint.rgb * transmitted;
    }
    float reflectance = fresnel_dielectric(-dot(view_direction, normal), 1.0 / material.ior);
    vec3 position = (frame.world_from_view * vec4(view_position(vec2(at.xy) + 0.5, imageLoad(layer_depth, at).r), 1.0)).xyz;
    vec3 mirrored = drawn(rough ? PELLUCID_DIRECT : PELLUCID_EMITTED,
                          reflectance * light_from_afar(position, reflect_direction(view_direction, normal), !(kHighlights && rough)));
    vec3 reflected = kReflected ? imageLoad(reflected_radiance, at).rgb : mirrored;
    if (kHighlights) reflected += mirrored;
    vec3 scattered = drawn(PELLUCID_DIRECT, (1.0 - reflectance) * diffuse_radiance(tint.rgb, normal));
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
    if (kAnalysis) {
        store_radiance(texel, shaded_analysis_color(at, view_direction, normal));
        return;
    }
    vec3 seen = glass_radiance(at, view_direction, normal, imageLoad(layer_triangle, at).r);
    see_lamps(texel, imageLoad(layer_depth, at).r, seen);
    store_radiance(texel, seen);
}
