#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;

    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    Fragment first = load_fragment(texel, 0u);
    if (first.triangle != PELLUCID_NO_TRIANGLE) {
        path.position = view_position(pixel, first.depth);
        cross_interface(path, view_normal(first), back_face(first.triangle), material_of(first).ior);
        // Seen from inside, the interface before this one is the one that is missing.
        if (back_face(first.triangle)) path.status = kStatusMissingLayer;
    }
    store_refraction(texel, path);
}
