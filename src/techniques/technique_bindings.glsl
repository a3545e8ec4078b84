#ifndef PELLUCID_TECHNIQUES_TECHNIQUE_BINDINGS_GLSL
#define PELLUCID_TECHNIQUES_TECHNIQUE_BINDINGS_GLSL

// Bindings 0 to 9, shared by techniques: the frame, the scene, the layers, and the result.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/layers.glsl"
#include "techniques/refraction.glsl"

// A technique of several passes that reads its own result defines this macro as empty.
#ifndef PELLUCID_RESULT_ACCESS
#define PELLUCID_RESULT_ACCESS writeonly
#endif

layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 3, r32f) readonly uniform image2DArray layer_depth;
layout(set = 0, binding = 4, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, rgba32f) PELLUCID_RESULT_ACCESS uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) PELLUCID_RESULT_ACCESS uniform image2DArray exit_position;
layout(set = 0, binding = 7, rgba32f) PELLUCID_RESULT_ACCESS uniform image2DArray transmittance;
layout(set = 0, binding = 8, r32ui) PELLUCID_RESULT_ACCESS uniform uimage2DArray path_events;

#include "layers/objects.glsl"

layout(set = 0, binding = 9, r32ui) readonly uniform uimage2DArray layer_normal;

Fragment load_fragment(ivec2 texel, uint layer) {
    return Fragment(imageLoad(layer_depth, ivec3(texel, layer)).r, imageLoad(layer_triangle, ivec3(texel, layer)).r);
}

MaterialRecord material_of(Fragment fragment) {
    return materials[objects[find_object(triangle_index(fragment.triangle))].material];
}

vec3 view_normal(ivec2 texel, uint layer) {
    return mat3(frame.view_from_world) * unpack_unit_vector(imageLoad(layer_normal, ivec3(texel, layer)).r);
}

void store_world_refraction(ivec2 texel, Path path) {
    ivec3 at = ivec3(texel, 0);
    imageStore(exit_direction, at, vec4(path.direction, path.length_inside));
    imageStore(exit_position, at, vec4(path.position, kEndsInEnvironment));
    imageStore(transmittance, at, vec4(path.transmittance, 1.0));
    imageStore(path_events, at, uvec4(pack_events(path)));
}

// Stores a path given in view space.
void store_refraction(ivec2 texel, Path path) {
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = normalize(mat3(frame.world_from_view) * path.direction);
    store_world_refraction(texel, path);
}

#endif
