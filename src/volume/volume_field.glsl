#ifndef PELLUCID_VOLUME_VOLUME_FIELD_GLSL
#define PELLUCID_VOLUME_VOLUME_FIELD_GLSL

// What is at a place in a volume (gpu/volume_images.h), interpolated linearly between the middles of voxels; beyond
// those at the faces it is what is there. Places are in voxel coordinates of the volume that was entered last.
//
// Needs: #extension GL_EXT_samplerless_texture_functions : require; volume_index (texture3D).
#include "volume/volume_record.glsl"

vec3 volume_size;    // of the volume that was entered last
ivec3 medium_first;  // texel of its box
ivec3 index_first;

// `channel`: 0 all (or green), else 1 red, 2 green, 3 blue.
void enter_volume(VolumeRecord record, uint channel) {
    volume_size = record.size;
    medium_first = record.first_texel;
    index_first = channel == 1u ? record.first_red.xyz : channel == 3u ? record.first_blue.xyz : record.first_index.xyz;
}

// By hand, because filtering of 32-bit float images is optional, and that of others has steps of 1/256 voxel.
vec4 interpolated(texture3D image, ivec3 first, vec3 x) {
    vec3 position = clamp(x - 0.5, vec3(0.0), volume_size - 1.0);
    vec3 corner = min(floor(position), volume_size - 2.0);
    vec3 w = position - corner;
    ivec3 at = first + ivec3(corner);
    vec4 low = mix(mix(texelFetch(image, at, 0), texelFetch(image, at + ivec3(1, 0, 0), 0), w.x),
                   mix(texelFetch(image, at + ivec3(0, 1, 0), 0), texelFetch(image, at + ivec3(1, 1, 0), 0), w.x), w.y);
    vec4 high = mix(mix(texelFetch(image, at + ivec3(0, 0, 1), 0), texelFetch(image, at + ivec3(1, 0, 1), 0), w.x),
                    mix(texelFetch(image, at + ivec3(0, 1, 1), 0), texelFetch(image, at + ivec3(1, 1, 1), 0), w.x), w.y);
    return mix(low, high, w.z);
}
vec4 volume_value(texture3D image, vec3 x) { return interpolated(image, medium_first, x); }

// Gradient per voxel, and the index; what optics/eikonal.glsl asks for.
vec4 index_field(vec3 x) { return interpolated(volume_index, index_first, x); }

#endif
