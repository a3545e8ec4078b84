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

// Ferguson's cubics through the indices and the gradients at the eight voxels around: the gradient is that of the value,
// which makes the order of an integrator its own, for no more texels than linear interpolation takes.
vec4 cubic_index(vec3 x) {
    vec3 position = clamp(x - 0.5, vec3(0.0), volume_size - 1.0);
    vec3 corner = min(floor(position), volume_size - 2.0);
    vec3 w = position - corner;
    // Of the value and the slope on either side, per axis; and their own slopes.
    vec3 value[2], slope[2], value_slope[2], slope_slope[2];
    value[1] = w * w * (3.0 - 2.0 * w);
    value[0] = 1.0 - value[1];
    slope[0] = w * (1.0 - w) * (1.0 - w);
    slope[1] = w * w * (w - 1.0);
    value_slope[1] = 6.0 * w * (1.0 - w);
    value_slope[0] = -value_slope[1];
    slope_slope[0] = (1.0 - w) * (1.0 - 3.0 * w);
    slope_slope[1] = w * (3.0 * w - 2.0);
    ivec3 first = index_first + ivec3(corner);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; ++k) {
        ivec3 side = ivec3(k & 1, k >> 1 & 1, k >> 2);
        vec4 at = texelFetch(volume_index, first + side, 0);
        vec3 h = vec3(value[side.x].x, value[side.y].y, value[side.z].z);
        vec3 t = vec3(slope[side.x].x, slope[side.y].y, slope[side.z].z);
        vec3 dh = vec3(value_slope[side.x].x, value_slope[side.y].y, value_slope[side.z].z);
        vec3 dt = vec3(slope_slope[side.x].x, slope_slope[side.y].y, slope_slope[side.z].z);
        vec3 others = vec3(h.y * h.z, h.z * h.x, h.x * h.y);
        sum.w += h.x * others.x * at.w + dot(t * others, at.xyz);
        sum.xyz += others * (dh * at.w + dt * at.xyz);
        sum.x += dh.x * (t.y * h.z * at.y + h.y * t.z * at.z);
        sum.y += dh.y * (t.z * h.x * at.z + h.z * t.x * at.x);
        sum.z += dh.z * (t.x * h.y * at.x + h.x * t.y * at.y);
    }
    return sum;
}

// Gradient per voxel, and the index; what optics/eikonal.glsl asks for.
#ifndef PELLUCID_CUBIC_INDEX
#define PELLUCID_CUBIC_INDEX false
#endif
vec4 index_field(vec3 x) {
    vec4 field = PELLUCID_CUBIC_INDEX ? cubic_index(x) : interpolated(volume_index, index_first, x);
    field.xyz *= step(vec3(0.5), x) * step(x, volume_size - 0.5);  // beyond, the index is what it is at the face
    return field;
}

#endif
