#version 460
// Takes every path on to the next surface, and past it if that is glass; where there is none, or an opaque one, the
// path ends.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "layers/surface_map.glsl"

layout(std430, set = 0, binding = 4) readonly buffer Solids { uint solids[]; };  // per rank: its material
layout(std430, set = 0, binding = 14) readonly buffer Maps { MapRecord maps[]; };
layout(set = 0, binding = 15) uniform utextureBuffer map_triangles;
layout(set = 0, binding = 16) uniform utextureBuffer texels;
layout(set = 0, binding = 17) uniform utextureBuffer records;
layout(set = 0, binding = 22) uniform utextureBuffer pyramid;
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/cross_surface.glsl"

// Rays enter and leave a solid in turn, so a surface that the path stands on is never met again.
bool can_meet(uint traits, bool leaving, uint triangle) {
    if ((traits & (kKindMask | kClosed)) != (kRefractiveKind | kClosed)) return triangle != standing;
    return (entered(rank_of(traits)) > 0u) == leaving;
}

#include "layers/surface_walk.glsl"

// A pane that bends no light: its two faces and the reflections between them are one factor.
void pass_pane(inout Path path, Surface surface) {
    MaterialRecord material = materials[surface.material];
    float once = fresnel_dielectric(abs(dot(path.direction, surface.normal)), 1.0 / material.ior);
    path.transmittance *= (1.0 - 2.0 * once / (1.0 + once)) * material.base_color.rgb * material.transmission;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    seed = hash(uvec3(texel, 1u)).x;
    Path path = load_path(i);
    bool in_map, gave_up;
    uint visits = 0u;
    SurfaceHit hit = find_surface(maps[0], path.position, path.direction, -coincidence, in_map, gave_up, visits);
    uint rank = filling_rank();
    bool found = hit.t < kFarthest;
    if (!found && rank != kAir) path.status = gave_up ? kStatusStepLimit : kStatusMissingLayer;
    bool glass = refractive(hit.traits);
    if (found && glass && path.events >= max_events) {
        path.status = kStatusEventLimit;
        found = false;
    }
    if (!found) {
        save_path(i, path);
        append_ended(texel);
        return;
    }
    Surface surface = surface_at(hit.triangle, object_of(hit.triangle), path.position, path.direction);
    if (rank != kAir) travel(path, distance(path.position, surface.position), filling_material(rank).sigma_a.rgb);
    path.position = surface.position;
    standing = hit.triangle;
    bool ends = (hit.traits & kKindMask) == kOpaqueKind;
    if (ends) mark |= kMetOpaque;
    else if (!glass) pass_pane(path, surface);
    else cross_surface(i, path, surface, hit.traits, hit.leaving, false);
    save_path(i, path);
    if (ends) append_ended(texel);
    else append_next(texel);
}
