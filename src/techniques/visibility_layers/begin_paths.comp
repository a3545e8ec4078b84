#version 460
// View rays, and what they do at the first surface of glass.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"

layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    Ray view = camera_ray(vec2(texel) + 0.5);
    Path path = camera_path(vec2(texel) + 0.5);
    path.position = (frame.world_from_view * vec4(view.origin, 1.0)).xyz;
    path.direction = mat3(frame.world_from_view) * view.direction;
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = 0u;

    uint first = imageLoad(layer_triangle, ivec3(texel, 0)).r;
    uint triangle = triangle_index(first), object = find_object(triangle);
    uint own_traits = traits[object];
    Surface surface = surface_at(triangle, object, path.position, path.direction);
    bool leaving = back_face(first);
    if (leaving) {  // the eye is inside, or the mesh is open
        set_entered(rank_of(own_traits), 1u);
        travel(path, distance(path.position, surface.position), filling_material(rank_of(own_traits)).sigma_a.rgb);
    }
    path.position = surface.position;
    standing = triangle;
    cross_surface(path, surface, own_traits, leaving);
    save_path(uint(texel.y) * frame.width + uint(texel.x), path);
    append_next(texel);
}
