#ifndef PELLUCID_VOLUME_SMOOTHED_SURFACE_GLSL
#define PELLUCID_VOLUME_SMOOTHED_SURFACE_GLSL

// Surfaces in volumes, which are as thick as the index is smoothed (Volume::boundary). What one does is known once it lies
// behind: its normal is the direction in which v has changed, and the indices on both sides say what it reflects
// (Fresnel). Needs: volume_absorption, volume/volume_field.glsl, volume/box.glsl, optics/interface.glsl.

const float kBoundaryEnds = 0.02;  // of the boundary field: below it a ray is in no surface
const float kLeastTurn = 1e-3;     // change of v in a surface that is none, or lies along the ray

struct Boundary {
    bool open;      // the ray is in one
    vec3 v;         // before it
    float n;        // likewise
    float highest;  // of the boundary field since then
    float lowest;   // since that
};
const Boundary kNoBoundary = Boundary(false, vec3(0.0), 1.0, 0.0, 0.0);

// The index beside a surface, a voxel away from x: what a grid has next to a jump swings a little. Where another surface is
// so near, at x.
float index_beside(vec3 x, vec3 away) {
    vec3 beside = x + away;
    bool clear = in_box(beside, volume_size) && volume_value(volume_absorption, beside).a <= kBoundaryEnds;
    return interpolated(volume_index, index_first, clear ? beside : x).y;
}

// At x, where v is still what it was before.
Boundary open_boundary(vec3 x, vec3 v, float field) {
    return Boundary(true, v, index_beside(x, -normalize(v)), field, field);
}

// Takes notice of the field at the end of a step. True: a surface lies behind. Of two that are so near to each other that
// the field does not fall to nothing between them, each ends in the valley.
bool passes_boundary(inout Boundary boundary, float field, bool inside) {
    if (!boundary.open) return false;
    if (field > boundary.highest) boundary.highest = boundary.lowest = field;
    boundary.lowest = min(boundary.lowest, field);
    return field <= kBoundaryEnds || !inside ||
           (boundary.lowest < 0.5 * boundary.highest && field > boundary.lowest + 0.1 * boundary.highest);
}

struct Passage {
    bool exists;        // else there was no surface
    bool reflected;     // totally
    vec3 normal;        // unit, against the ray that comes
    float reflectance;  // 0..1, where the ray has passed
};

// `v`: behind the surface, at x. What of it lies along the surface is as before.
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
