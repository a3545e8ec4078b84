#ifndef PELLUCID_VOLUME_BOX_GLSL
#define PELLUCID_VOLUME_BOX_GLSL

#include "volume/volume_record.glsl"

// Clips a ray from x on to the box of a volume. `near` and `far` are in units of d; near > far if the ray misses.
void clip_to_box(VolumeRecord volume, vec3 x, vec3 d, out float near, out float far) {
    near = 0.0;
    far = 1e30;
    for (int k = 0; k < 3; ++k) {
        if (abs(d[k]) < 1e-12) {
            if (x[k] < 0.0 || x[k] > volume.size[k]) far = -1.0;
            continue;
        }
        float a = -x[k] / d[k], b = (volume.size[k] - x[k]) / d[k];
        near = max(near, min(a, b));
        far = min(far, max(a, b));
    }
}

const float kLeastCrossing = 1e-3;  // voxels; a shorter passage through a box is a miss

// Distance along a straight ray to the box of a volume, m; 1e30 if it misses.
float box_distance(VolumeRecord volume, vec3 position, vec3 direction) {
    float near, far;
    clip_to_box(volume, (volume.voxel_from_world * vec4(position, 1.0)).xyz,
                mat3(volume.voxel_from_world) * direction * volume.voxel, near, far);
    return far - near > kLeastCrossing ? near * volume.voxel : 1e30;
}

bool in_box(vec3 x, vec3 size) { return all(greaterThanEqual(x, vec3(0.0))) && all(lessThanEqual(x, size)); }

#endif
