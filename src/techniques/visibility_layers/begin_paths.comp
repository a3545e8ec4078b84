#version 460
// View rays of an eye outside all media, up to and across the first surface of glass.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "layers/surface_map.glsl"
#include "gpu/object_traits.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(std430, set = 0, binding = 4) readonly buffer Slots { SlotRecord slots[]; };
layout(std430, set = 0, binding = 38) readonly buffer ShellTraits { uint shell_traits[]; };  // per triangle of meshes
layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2DArray reflected_radiance;
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 29) uniform utextureBuffer map_normals;

#include "techniques/visibility_layers/path_state.glsl"
#include "gpu/vertices.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"
#include "techniques/visibility_layers/cross_boundary.glsl"

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    waiting[i] = uvec2(0u);
    imageStore(path_radiance, ivec3(texel, 0), vec4(0.0, 0.0, 0.0, kStochastic || kTree ? 1.0 : 0.0));
    imageStore(reflected_radiance, ivec3(texel, 0), vec4(0.0));
    Ray view = camera_ray(vec2(texel) + 0.5);
    PathState state;
    state.path = camera_path(vec2(texel) + 0.5);
    state.path.position = (frame.world_from_view * vec4(view.origin, 1.0)).xyz;
    state.path.direction = mat3(frame.world_from_view) * view.direction;
    clear_media(state.media);
    state.standing = PELLUCID_NO_TRIANGLE;
    state.mark = kMainPath;
    state.pixel = i;
    state.seed = sample_seed(texel);

    uint first = imageLoad(layer_triangle, ivec3(texel, 0)).r;
    uint triangle = triangle_index(first), object = object_of(triangle);
    uint own_traits = traits[object];
    if (kManySlots) own_traits += shell_traits[triangle - objects[object].first_triangle + objects[object].first_corner / 3u];
    bool leaving = back_face(first);
    if (!leaving || (own_traits & kClosed) == 0u) {  // otherwise the near plane has clipped the entry
        Crossing crossing;
        crossing.surface = surface_at(triangle, object, state.path.position, state.path.direction);
        crossing.leaving = leaving;
        crossing.first = !leaving;
        state.path.position = crossing.surface.position;
        state.standing = triangle;
        correct_side(state.media, own_traits, leaving);
        copy_media(state.media, crossing.here);
        step_across(state.media, own_traits, leaving);
        copy_media(state.media, crossing.there);
        uint before = filling_body(crossing.here), beyond = filling_body(crossing.there);
        crossing.n_i = filling_iors(before);
        crossing.n_t = filling_iors(beyond);
        if (is_interface(before, beyond)) cross_boundary(state, crossing);
    }
    save_path(state);
    append_next(texel);
}
