#version 460
// Takes every path on to the next surface, and past it; where there is none the path ends.
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "layers/surface_map.glsl"

layout(std430, set = 0, binding = 14) readonly buffer Maps { MapRecord maps[]; };
layout(std430, set = 0, binding = 15) readonly buffer MapTriangles { vec4 map_triangles[]; };
layout(std430, set = 0, binding = 16) readonly buffer Texels { TexelRecords texels[]; };
layout(std430, set = 0, binding = 17) readonly buffer Records { uvec4 records[]; };
layout(std430, set = 0, binding = 22) readonly buffer Pyramid { uvec4 pyramid[]; };

layout(set = 0, binding = 5, rgba32f) writeonly uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2DArray exit_position;
layout(set = 0, binding = 7, rgba32f) writeonly uniform image2DArray transmittance;
layout(set = 0, binding = 8, r32ui) writeonly uniform uimage2DArray path_events;

layout(push_constant) uniform Push {
    uint last;         // 1: paths that meet another surface have too many events
    float t_min;       // m; surfaces that far behind are ahead, by the rounding of their places
};

// Rays enter and leave a solid in turn, so a surface that the path stands on is never met again.
bool can_meet(uint traits, bool leaving, uint triangle) {
    if ((traits & (kKindMask | kClosed)) != (kRefractiveKind | kClosed)) return triangle != standing;
    return (entered(rank_of(traits)) > 0u) == leaving;
}

#include "layers/surface_walk.glsl"

void finish(ivec2 texel, Path path, float object) {
    ivec3 at = ivec3(texel, 0);
    imageStore(exit_direction, at, vec4(path.direction, path.length_inside));
    imageStore(exit_position, at, vec4(path.position, object));
    imageStore(transmittance, at, vec4(path.transmittance, 1.0));
    imageStore(path_events, at, uvec4(pack_events(path)));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    Path path = load_path(i);
    bool in_map, gave_up;
    uint visits = 0u;
    SurfaceHit hit = find_surface(maps[0], path.position, path.direction, t_min, in_map, gave_up, visits);
    uint rank = filling_rank();
    if (hit.t >= kFarthest) {
        if (rank != kAir) path.status = gave_up ? kStatusStepLimit : kStatusMissingLayer;
        finish(texel, path, kEndsInEnvironment);
        return;
    }
    if (last != 0u) {
        path.status = kStatusEventLimit;
        finish(texel, path, kEndsInEnvironment);
        return;
    }
    uint object = find_object(hit.triangle);
    Surface surface = surface_at(hit.triangle, object, path.position, path.direction);
    float way = distance(path.position, surface.position);
    if (rank != kAir) travel(path, way, filling_material(rank).sigma_a.rgb);
    path.position = surface.position;
    standing = hit.triangle;
    cross_surface(path, surface, hit.traits, hit.leaving);
    save_path(i, path);
    append_next(texel);
}
