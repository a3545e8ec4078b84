#version 460
// Paths of pixels with an opaque surface, for the light that the rasteriser does not draw. They start on the surface.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "layers/surface_map.glsl"
#include "gpu/object_traits.glsl"

layout(std430, set = 0, binding = 4) readonly buffer Slots { SlotRecord slots[]; };
layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, r32ui) readonly uniform uimage2DArray opaque_triangle;
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 29) uniform utextureBuffer map_normals;

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    uint triangle = imageLoad(opaque_triangle, ivec3(texel, 0)).r;
    bool has_path = behind_glass == 0u && imageLoad(layer_triangle, ivec3(texel, 0)).r != PELLUCID_NO_TRIANGLE;
    if (triangle == PELLUCID_NO_TRIANGLE || has_path) return;
    PathState state;
    state.path = camera_path(vec2(texel) + 0.5);
    vec3 origin = (frame.world_from_view * vec4(state.path.position, 1.0)).xyz;
    state.path.direction = normalize(mat3(frame.world_from_view) * state.path.direction);
    state.path.position = surface_at(triangle, object_of(triangle), origin, state.path.direction).position;
    clear_media(state.media);
    state.standing = triangle;
    state.mark = kMainPath | kOpaquePixel | kMetOpaque;
    state.pixel = uint(texel.y) * frame.width + uint(texel.x);
    waiting[state.pixel] = uvec2(0u);
    save_path(state);
    append_ended(texel);
}
