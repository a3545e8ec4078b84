#version 460
// View rays that find the diffuse surfaces at which irradiance is gathered.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_walk.glsl"
#include "light/irradiance_points.glsl"

layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray path_radiance;
layout(set = 0, binding = 8, rgba32f) writeonly uniform image2DArray reflected_radiance;
layout(std430, set = 0, binding = 39) readonly buffer EyeMedia { uint eye_media[]; };  // one bit per slot
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    waiting[i] = uvec2(0u);
    points[i].normal = kNoIrradiance;
    imageStore(path_radiance, ivec3(texel, 0), vec4(0.0));
    imageStore(reflected_radiance, ivec3(texel, 0), vec4(0.0));
    PathState state;
    Path path = camera_path(vec2(texel) + 0.5);
    float along_axis = -path.direction.z;
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = normalize(mat3(frame.world_from_view) * path.direction);
    path.position += eye_depth / along_axis * path.direction;
    for (uint w = 0u; w < kMediumWords; ++w) state.media.words[w] = eye_media[w];
    if (eye_differs != 0u && !kFoundOnHost) find_media(path.position, path.direction, state.media);
    state.path = path;
    state.mark = kMainPath;
    state.standing = PELLUCID_NO_TRIANGLE;
    state.pixel = i;
    save_path(state);
    append_next(texel);
}
