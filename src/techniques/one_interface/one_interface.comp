#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"
#include "layers/pixel_list.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    Fragment first = load_fragment(texel, 0u);
    MaterialRecord material = material_of(first);
    vec3 position = view_position(pixel, first.depth);
    if (back_face(first.triangle)) {  // seen from inside: the interface before this one is missing
        travel(path, distance(path.position, position), material.sigma_a.rgb);
        path.status = kStatusMissingLayer;
    }
    path.position = position;
    cross_interface(path, view_normal(texel, 0u), back_face(first.triangle), material.ior);
    store_refraction(texel, path);
}
