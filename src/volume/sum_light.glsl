#ifndef PELLUCID_VOLUME_SUM_LIGHT_GLSL
#define PELLUCID_VOLUME_SUM_LIGHT_GLSL

// Voxels add up all light that passes them: power times path length, mean colour and mean direction. Divided by the
// volume of a voxel, power times length is the fluence rate, W/m2. This method is ours. Needs:
// volume/step_bindings.glsl.

// Wide counters, seven per voxel. The first sums trilinear shares of nearby light, as light_lookup.glsl interpolates
// them. The others sum light inside the voxel: all of it, its red and green parts, and (1 + way) / 2. The latter is
// never negative. Ratios of these counters do not depend on how many points fall into a voxel.
layout(std430, set = 0, binding = 11) buffer Sums { uint sums[]; };

const float kPointsPerVoxel = 2.0;  // points per voxel along a side of a patch
const float kMostPoints = 16.0;     // most points of a patch with all its first power; proportional for others

uint light_voxel(LightPlacement placement, ivec3 at) {
    ivec3 size = ivec3(placement.size_x, placement.size_y, placement.size_z);
    at = clamp(at, ivec3(0), size - 1);
    return placement.first_key + uint(at.x + size.x * (at.y + size.y * at.z));
}

void add_to_sum(uint counter, float amount) {
    uvec2 units = power_units(amount);
    if (units != uvec2(0u)) PELLUCID_ADD_WIDE(sums, counter, units)
}

void add_to_voxels(LightPlacement placement, vec3 x, vec3 amount, vec3 way) {
    x /= float(1u << placement.halvings);
    vec3 corner = floor(x - 0.5), w = x - 0.5 - corner;
    float all = amount.r + amount.g + amount.b;
    for (int k = 0; k < 8; ++k) {
        ivec3 offset = ivec3(k & 1, k >> 1 & 1, k >> 2);
        vec3 shares = mix(1.0 - w, w, vec3(offset));
        add_to_sum(7u * light_voxel(placement, ivec3(corner) + offset), shares.x * shares.y * shares.z * all);
    }
    uint own = 7u * light_voxel(placement, ivec3(floor(x)));
    add_to_sum(own + 1u, all);
    add_to_sum(own + 2u, amount.r);
    add_to_sum(own + 3u, amount.g);
    for (uint k = 0u; k < 3u; ++k) add_to_sum(own + 4u + k, 0.5 * all * (1.0 + way[k]));
}

// Distributes the light of a step to a grid of points across the patch, half-way through the step. The grid shifts from
// step to step by a low-discrepancy sequence (R2, Roberts 2018). Every second shift is the opposite of the one before,
// so that their mean is the patch's centre.
void keep_light(VolumeRecord volume, LightPlacement placement, PassingLight light) {
    vec3 x[4];
    for (int k = 0; k < 4; ++k) x[k] = 0.5 * (light.from[k] + light.to[k]);
    vec2 sides = vec2(max(distance(x[0], x[1]), distance(x[3], x[2])), max(distance(x[0], x[3]), distance(x[1], x[2])));
    vec2 wanted = max(kPointsPerVoxel * sides, vec2(1.0));
    float most = kMostPoints * light.first_share;
    ivec2 points = ivec2(max(ceil(wanted * min(1.0, sqrt(most / (wanted.x * wanted.y))) - 1e-3), vec2(1.0)));
    vec2 shift = fract(0.5 + float(light.step_number / 2u) * vec2(0.7548777, 0.5698403));
    if (light.step_number % 2u == 1u) shift = 1.0 - shift;
    shift = mix(shift, vec2(0.5), greaterThan(points, ivec2(1)));
    vec3 amount = light.mean_power * light.length_m / (volume.voxel * float(points.x * points.y));
    for (int i = 0; i < points.x * points.y; ++i) {
        vec2 at = (vec2(i % points.x, i / points.x) + shift) / vec2(points);
        vec3 place = mix(mix(x[0], x[1], at.x), mix(x[3], x[2], at.x), at.y);
        if (in_box(place, volume.size)) add_to_voxels(placement, place, amount, light.way);
    }
}

#endif
