#ifndef PELLUCID_VOLUME_MIRROR_LIGHT_GLSL
#define PELLUCID_VOLUME_MIRROR_LIGHT_GLSL

// Light that a surface in a volume reflects becomes a new patch, once the old patch is behind the surface. Steps of
// light are reversible, so each corner is traced back to where it met the surface. From there it continues straight on,
// as if there were no surface, and is mirrored. All corners keep the same optical length.
//
// Needs: volume/step_bindings.glsl.

const int kMostStepsBack = 96;   // most steps back in all; grazing rays need many
const int kMostStepsTo = 32;     // most steps back until the surface begins
const float kLikeMiddle = 0.05;  // largest relative difference of n between a corner and the centre

// Mirrors a ray at the surface behind it. False if there is none. `lag`: optical length, voxels, that the mirrored ray
// needs to leave the surface.
bool mirror_ray(inout vec3 x, inout vec3 v, out vec3 normal, out float lag) {
    Boundary boundary = kNoBoundary;
    vec3 x_before = x, v_back = -v, crossing = vec3(0.0);
    float turns = 0.0, optical = 0.0;
    bool found = false;
    for (int s = 0; s < kMostStepsBack && !found && (boundary.open || s < kMostStepsTo); ++s) {
        vec3 x_last = x_before, v_last = v_back;
        step_corner(x_before, v_back, step_length);
        optical += step_length;
        float turn = distance(v_back, v_last);
        crossing += turn * 0.5 * (x_last + x_before);
        turns += turn;
        float field = volume_value(volume_absorption, x_before).a;
        found = passes_boundary(boundary, field, in_box(x_before, volume_size));
        if (field > kBoundaryEnds && !boundary.open) boundary = Boundary(true, vec3(0.0), 1.0, field, field);
    }
    vec3 turned = v + v_back;
    if (!found || length(turned) < kLeastTurn) return false;
    crossing /= turns;
    normal = normalize(turned);
    float n = length(v_back);
    vec3 straight = x_before - optical * v_back / (n * n);
    x = straight - 2.0 * dot(straight - crossing, normal) * normal;
    v = 2.0 * dot(v_back, normal) * normal - v_back;
    lag = 2.0 * n * distance(x_before, crossing) - optical;
    return true;
}

// Mirrors a patch at the surface behind it. False if the surface is not found. A corner that meets another surface than
// the centre, as at silhouettes, follows the centre.
bool mirror_patch(inout Quad quad, float voxel) {
    vec3 behind = middle(quad.x), centre = behind, way = mean_v(quad.v), normal;
    float lag;
    if (!mirror_ray(centre, way, normal, lag)) return false;
    float n = length(way);
    vec3 x[4], v[4];
    for (int k = 0; k < 4; ++k) {
        x[k] = quad.x[k];
        v[k] = quad.v[k];
        vec3 own_normal;
        float own_lag;
        bool found = mirror_ray(x[k], v[k], own_normal, own_lag);
        if (found && abs(length(v[k]) - n) < kLikeMiddle * n && dot(v[k], way) > 0.5 * n * n) {
            lag = max(lag, own_lag);
        } else {
            vec3 offset = quad.x[k] - behind;
            x[k] = centre + offset - 2.0 * dot(offset, normal) * normal;
            v[k] = way;
        }
    }
    lag = max(lag, 0.0) + step_length;
    for (int k = 0; k < 4; ++k) {
        int to = (4 - k) % 4;  // mirroring reverses the order of corners
        quad.x[to] = x[k] + lag * v[k] / dot(v[k], v[k]);
        quad.v[to] = normalize(v[k]) * (in_box(quad.x[to], volume_size) ? index_field(quad.x[to]).w : 1.0);
    }
    quad.optical += lag * voxel;
    quad.surface = vec4(0.0);
    ++quad.reflections;
    return true;
}

#endif
