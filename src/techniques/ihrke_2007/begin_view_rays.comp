#version 460
// View rays of the pixels in which there is glass or a volume; they start at the eye.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "gpu/object_traits.glsl"
#include "volume/volume_record.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2DArray reflected_radiance;
layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

#include "techniques/visibility_layers/path_state.glsl"
#include "volume/volume_boxes.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    ivec3 at = ivec3(texel, 0);
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    waiting[i] = uvec2(0u);
    Path path = camera_path(vec2(texel) + 0.5);
    float along_axis = -path.direction.z;
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = normalize(mat3(frame.world_from_view) * path.direction);
    float straight;
    float opaque = imageLoad(opaque_depth, at).r;
    bool meets_volume = next_volume(path.position, path.direction, straight) != kNoVolume && straight * along_axis < opaque;
    bool meets_lit = light_count > 0u && opaque < PELLUCID_EMPTY_DEPTH;  // drawn without lights so far
    uint first = imageLoad(layer_triangle, at).r;
    uint own_traits = first != PELLUCID_NO_TRIANGLE ? traits[object_of(triangle_index(first))] : 0u;
    bool meets_glass = first != PELLUCID_NO_TRIANGLE && (own_traits & kReplaced) == 0u;
    bool begins = meets_volume || meets_glass || meets_lit;
    imageStore(path_radiance, at, vec4(0.0, 0.0, 0.0, begins ? 1.0 : 0.0));
    imageStore(reflected_radiance, at, vec4(0.0));
    if (!begins) return;
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = 0u;
    if (meets_glass && back_face(first))  // the eye is inside, or the mesh is open
        set_entered(rank_of(own_traits), 1u);
    mark = kMainPath;
    standing = PELLUCID_NO_TRIANGLE;
    save_path(i, path);
    append_next(texel);
}
