#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_BEGIN_AT_EYE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_BEGIN_AT_EYE_GLSL

// View rays that start at the eye, or at the near plane, because the first layer alone does not give their first hit.
// These are the pixels with glass, or all pixels if the eye is in a medium.
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_walk.glsl"
#include "volume/volume_record.glsl"

layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 63, r32ui) readonly uniform uimage2DArray opaque_triangle;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2DArray reflected_radiance;
layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
layout(std430, set = 0, binding = 39) readonly buffer EyeMedia { uint eye_media[]; };  // one bit per slot
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
#include "volume/volume_boxes.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    ivec3 at = ivec3(texel, 0);
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    waiting[i] = uvec2(0u);
    PathState state;
    Path path = camera_path(vec2(texel) + 0.5);
    float along_axis = -path.direction.z;
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = normalize(mat3(frame.world_from_view) * path.direction);
    path.position += eye_depth / along_axis * path.direction;
    bool in_medium = false;
    for (uint w = 0u; w < kMediumWords; ++w) state.media.words[w] = eye_media[w];
    if (eye_differs != 0u) {
        in_medium = kFoundOnHost;  // assumed until the host has found the media
        if (!kFoundOnHost) find_media(path.position, path.direction, state.media);
    }
    for (uint w = 0u; w < kMediumWords; ++w) in_medium = in_medium || state.media.words[w] != 0u;
    uint first = imageLoad(layer_triangle, at).r;
    bool begins = in_medium;
    if (first != PELLUCID_NO_TRIANGLE)
        begins = begins || !kVolumes || proxy == kSharpInterfaces || (traits[object_of(triangle_index(first))] & kReplaced) == 0u;
    // Opaque surfaces were drawn without lights so far.
    if (kLightsSurfaces && whole_picture != 0u) begins = begins || imageLoad(opaque_triangle, at).r != PELLUCID_NO_TRIANGLE;
    if (kVolumes) {
        float straight, opaque = imageLoad(opaque_depth, at).r;
        begins = begins || (light_count > 0u && opaque < PELLUCID_EMPTY_DEPTH);  // drawn without lights so far
        begins = begins || (next_volume(path.position, path.direction, volumes_of(false, proxy), straight) != kNoVolume && straight * along_axis < opaque);
    }
    bool shades = whole_picture != 0u && begins;
    imageStore(path_radiance, at, vec4(0.0, 0.0, 0.0, shades || ((kStochastic || kTree) && begins) ? 1.0 : 0.0));
    imageStore(reflected_radiance, at, vec4(0.0));
    if (!begins) return;
    state.path = path;
    state.mark = kMainPath;
    state.standing = PELLUCID_NO_TRIANGLE;
    state.pixel = i;
    save_path(state);
    append_next(texel);
}

#endif
