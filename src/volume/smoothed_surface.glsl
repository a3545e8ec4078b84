#ifndef PELLUCID_VOLUME_SMOOTHED_SURFACE_GLSL
#define PELLUCID_VOLUME_SMOOTHED_SURFACE_GLSL

// Surfaces in volumes, whose thickness is that of the smoothing of the index (Volume::boundary). The effect of a
// surface is known once the ray is behind it. Its normal is the direction in which v has changed. The indices on both
// sides give its reflectance (Fresnel). Needs: volume_absorption, volume/volume_field.glsl, volume/box.glsl,
// optics/interface.glsl.

const float kBoundaryEnds = 0.02;  // value of the boundary field below which a ray is outside all surfaces
const float kLeastTurn = 1e-3;     // least change of v at a surface

struct Boundary {
    bool open;      // the ray is in a surface
    vec3 v;         // before the surface
    float n;        // before the surface
    float highest;  // highest value of the boundary field in the surface so far
    float lowest;   // lowest value since the highest
};
const Boundary kNoBoundary = Boundary(false, vec3(0.0), 1.0, 0.0, 0.0);

// The index beside a surface, at x + `away`, because a sampled index oscillates slightly next to a jump. The index at x
// if another surface is at x + `away`.
float index_beside(vec3 x, vec3 away) {
    vec3 beside = x + away;
    bool clear = in_box(beside, volume_size) && volume_value(volume_absorption, beside).a <= kBoundaryEnds;
    return interpolated(volume_index, index_first, clear ? beside : x).y;
}

// Opens a boundary at x, where v has not changed yet.
Boundary open_boundary(vec3 x, vec3 v, float field) {
    return Boundary(true, v, index_beside(x, -normalize(v)), field, field);
}

// Updates the boundary with the field at the end of a step. True if the surface is now behind the ray. If the field
// does not vanish between two surfaces, because they are near, the first ends at the minimum between them.
bool passes_boundary(inout Boundary boundary, float field, bool inside) {
    if (!boundary.open) return false;
    if (field > boundary.highest) boundary.highest = boundary.lowest = field;
    boundary.lowest = min(boundary.lowest, field);
    return field <= kBoundaryEnds || !inside ||
           (boundary.lowest < 0.5 * boundary.highest && field > boundary.lowest + 0.1 * boundary.highest);
}

struct Passage {
    bool exists;        // false: there was no surface
    bool reflected;     // total reflection
    vec3 normal;        // unit, against the incident ray
    float reflectance;  // 0..1, if the ray has passed
};

// The passage of a ray through a surface. `v`: behind the surface, at x. Its tangential part is the same as before.
Passage pass_surface(Boundary boundary, vec3 x, vec3 v) {
    Passage passage = Passage(false, false, vec3(0.0), 0.0);
    vec3 turned = v - boundary.v;
    passage.exists = length(turned) > kLeastTurn;
    if (!passage.exists) return passage;
    vec3 normal = normalize(turned);
    if (dot(boundary.v, normal) > 0.0) normal = -normal;
    float n_t = index_beside(x, normalize(v));
    vec3 along = boundary.v - dot(boundary.v, normal) * normal;
    passage.normal = normal;
    passage.reflected = dot(v, normal) > 0.0;
    if (passage.reflected) return passage;
    float cosine = sqrt(max(1.0 - dot(along, along) / (boundary.n * boundary.n), 0.0));
    passage.reflectance = fresnel_dielectric(cosine, boundary.n / n_t);
    return passage;
}

#endif
