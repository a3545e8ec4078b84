#version 460
// View rays, and what they do at the first surface of glass.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "layers/surface_map.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(std430, set = 0, binding = 4) readonly buffer Solids { uint solids[]; };  // per rank: its material
layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2DArray reflected_radiance;
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 29) uniform utextureBuffer map_normals;

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    seed = hash(uvec3(texel, 1u)).x;
    waiting[i] = uvec2(0u);
    imageStore(path_radiance, ivec3(texel, 0), vec4(0.0, 0.0, 0.0, kStochastic ? 1.0 : 0.0));
    imageStore(reflected_radiance, ivec3(texel, 0), vec4(0.0));
    Ray view = camera_ray(vec2(texel) + 0.5);
    Path path = camera_path(vec2(texel) + 0.5);
    path.position = (frame.world_from_view * vec4(view.origin, 1.0)).xyz;
    path.direction = mat3(frame.world_from_view) * view.direction;
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = 0u;
    mark = kMainPath;

    uint first = imageLoad(layer_triangle, ivec3(texel, 0)).r;
    uint triangle = triangle_index(first), object = object_of(triangle);
    uint own_traits = traits[object];
    Surface surface = surface_at(triangle, object, path.position, path.direction);
    bool leaving = back_face(first);
    if (leaving) {  // the eye is inside, or the mesh is open
        set_entered(rank_of(own_traits), 1u);
        travel(path, distance(path.position, surface.position), filling_material(rank_of(own_traits)).sigma_a.rgb);
    }
    path.position = surface.position;
    standing = triangle;
    note_here();
    step_across(own_traits, leaving);
    note_there();
    uint beyond = filling_rank();
    if (leaving) meet_boundary(i, path, surface, true, filling_iors(rank_of(own_traits)), filling_iors(beyond), false);
    else meet_boundary(i, path, surface, false, vec3(1.0), filling_iors(beyond), true);
    save_path(i, path);
    append_next(texel);
}
