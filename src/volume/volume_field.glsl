#ifndef PELLUCID_VOLUME_VOLUME_FIELD_GLSL
#define PELLUCID_VOLUME_VOLUME_FIELD_GLSL

// Values of fields at positions in a volume (gpu/volume_images.h). Positions are voxel coordinates of the volume that
// was entered last. Values are constant beyond the centres of the voxels at its faces.
//
// Needs: #extension GL_EXT_samplerless_texture_functions : require; volume_index, volume_bricks (texture3D).
#include "volume/volume_record.glsl"

vec3 volume_size;    // of the volume that was entered last
ivec3 medium_first;  // first texel of its box in the images of media
ivec3 index_first;   // first texel of its box in the image of the index

// Makes `record` the current volume. `channel`: 0 all (or green), 1 red, 2 green, 3 blue.
void enter_volume(VolumeRecord record, uint channel) {
    volume_size = record.size;
    medium_first = record.first_texel;
    index_first = channel == 1u ? record.first_red.xyz : channel == 3u ? record.first_blue.xyz : record.first_index.xyz;
}

// Trilinear interpolation. The shader interpolates, because hardware filtering of 32-bit float images is optional, and
// that of other formats has steps of 1/256 voxel.
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

// Interpolation of the index. False: value and central differences are interpolated linearly, each by itself, as in the
// paper. True: uniform cubic B-splines, with the gradient of the value. They smooth the index with a variance of
// 1/3 voxel^2.
#ifndef PELLUCID_CUBIC_INDEX
#define PELLUCID_CUBIC_INDEX false
#endif

// Weights of four voxels in a row for the value and the slope at f (0..1) between the second and the third. Values
// beyond a face are extrapolated from the two voxels there. Along x the image already contains them.
void row_shares(float f, bool first, bool last, out vec4 value, out vec4 slope) {
    float g = 1.0 - f;
    if (PELLUCID_CUBIC_INDEX) {
        value = vec4(g * g * g, 4.0 - 3.0 * f * f * (2.0 - f), 4.0 - 3.0 * g * g * (2.0 - g), f * f * f) / 6.0;
        slope = 0.5 * vec4(-g * g, f * (3.0 * f - 4.0), -g * (3.0 * g - 4.0), f * f);
    } else {
        value = vec4(0.0, g, f, 0.0);
        slope = 0.5 * vec4(-g, -f, g, f);
    }
    if (first) {
        value += value.x * vec4(-1.0, 2.0, -1.0, 0.0);
        slope += slope.x * vec4(-1.0, 2.0, -1.0, 0.0);
    }
    if (last) {
        value += value.w * vec4(0.0, -1.0, 2.0, -1.0);
        slope += slope.w * vec4(0.0, -1.0, 2.0, -1.0);
    }
}

// The brick of 8^3 cells at a position. x: index if uniform, else 0; y: 1 if the media are uniform, else 0.
const int kBrick = 8;
vec2 brick_at(vec3 x) {
    vec3 corner = min(floor(clamp(x - 0.5, vec3(0.0), volume_size - 1.0)), volume_size - 2.0);
    return texelFetch(volume_bricks, (index_first + ivec3(corner)) / kBrick, 0).xy;
}

// Length, voxels, over which neither the index nor a medium changes along a ray, so that it is straight; 0 if none.
float even_way(vec3 x, vec3 way) {
    vec2 brick = brick_at(x);
    if (brick.x == 0.0 || brick.y == 0.0) return 0.0;
    vec3 position = x - 0.5, low = floor(clamp(position, vec3(0.0), volume_size - 2.0) / float(kBrick)) * float(kBrick);
    vec3 face = low + float(kBrick) * step(vec3(0.0), way);
    vec3 until = mix((face - position) / way, vec3(1e30), lessThan(abs(way), vec3(1e-6)));
    return max(min(until.x, min(until.y, until.z)), 0.0);
}

// Gradient per voxel (xyz) and index (w), as optics/eikonal.glsl needs them.
vec4 index_field(vec3 x) {
    vec2 brick = brick_at(x);
    if (brick.x > 0.0) return vec4(0.0, 0.0, 0.0, brick.x);
    vec3 position = clamp(x - 0.5, vec3(0.0), volume_size - 1.0);
    vec3 corner = min(floor(position), volume_size - 2.0);
    vec4 value[3], slope[3];
    ivec3 low = ivec3(corner), last = ivec3(volume_size) - 1;
    for (int k = 0; k < 3; ++k)
        row_shares(position[k] - corner[k], k > 0 && low[k] == 0, k > 0 && low[k] + 1 == last[k], value[k], slope[k]);
    vec4 sum = vec4(0.0);
    for (int z = 0; z < 4; ++z) {
        for (int y = 0; y < 4; ++y) {
            if (!PELLUCID_CUBIC_INDEX && (y == 0 || y == 3) && (z == 0 || z == 3)) continue;
            ivec2 at = clamp(low.yz + ivec2(y, z) - 1, ivec2(0), last.yz);
            vec4 row = texelFetch(volume_index, index_first + ivec3(low.x, at), 0);
            float along = dot(value[0], row), share = value[1][y] * value[2][z];
            sum += vec4(share * dot(slope[0], row), slope[1][y] * value[2][z] * along, value[1][y] * slope[2][z] * along,
                        share * along);
        }
    }
    sum.xyz *= step(vec3(0.5), x) * step(x, volume_size - 0.5);  // the index is constant beyond the outer centres
    return sum;
}

#endif
