#version 460
// Marches every path at a volume to its exit from the box, or to a surface inside. Ihrke et al. 2007, sections 3 and
// 4.1.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_walk.glsl"
#include "techniques/visibility_layers/path_light.glsl"

// Constants of visibility_bindings.glsl have ids up to 14.
layout(constant_id = 16) const uint kIntegrator = 1u;  // integrator of optics/eikonal.glsl
layout(constant_id = 17) const bool kAbsorbs = false;
layout(constant_id = 18) const bool kBoundaries = false;  // some volume has reflecting surfaces
layout(constant_id = 19) const bool kScatters = false;
layout(constant_id = 20) const bool kEmits = false;
layout(constant_id = 21) const bool kDisperses = false;
layout(constant_id = 22) const bool kSurfacesInside = false;  // objects may lie in volumes
layout(constant_id = 23) const bool kOverlapping = false;     // volumes may lie in volumes
layout(constant_id = 26) const bool kLit = false;             // light was traced through the volumes
layout(constant_id = 24) const float kStep = 0.5;             // voxels
layout(constant_id = 27) const bool kCubic = false;           // cubic interpolation of the index
layout(constant_id = 25) const uint kMostSteps = 8192u;       // steps between two surfaces or boxes

layout(set = 0, binding = 5) uniform texture3D volume_index;
layout(set = 0, binding = 38) uniform texture3D volume_bricks;
layout(set = 0, binding = 6) uniform texture3D volume_absorption;
layout(set = 0, binding = 9) uniform texture3D volume_scattering;
layout(set = 0, binding = 27) uniform texture3D volume_emission;
#define PELLUCID_CUBIC_INDEX kCubic
#include "volume/volume_field.glsl"
#include "optics/eikonal.glsl"
#include "optics/transmittance.glsl"
#include "techniques/ihrke_2007/light_bindings.glsl"
#include "volume/smoothed_surface.glsl"
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
PELLUCID_APPENDED_LIST(EndedList, 25, ended_groups, ended_length, ended_pixels, append_ended)

const float kAirIndex = 1.01;        // a ray in a lower index has left the glass
const float kReachGrows = 4.0;       // look-ahead for surfaces, relative to the path length since the last search
const float kStraight = 1.0 - 1e-6;  // cosine above which a ray keeps its search direction

void branch_from(PathState state, vec3 place, vec3 way, vec3 weight, uint mark) {
    state.path.position = place;
    state.path.direction = way;
    state.path.transmittance = weight;
    state.mark = mark & ~(kMainPath | kEntersVolume);
    push_branch(state, branch_capacity, true);
}

void leave_boundary(inout PathState state, Boundary boundary, vec3 began, vec3 x, vec3 v, VolumeRecord volume,
                    mat3 world_from_voxel) {
    Passage passage = pass_surface(boundary, x, v);
    if (!passage.exists) return;
    ++state.path.events;
    if (passage.reflected) {
        ++state.path.reflections;
        return;
    }
    vec3 reflected = state.path.transmittance * passage.reflectance;
    // the transmitted path carries the reflected light too, so no energy is lost
    if (!kTree || !may_branch(state.pixel, reflected)) return;
    vec3 way = normalize(world_from_voxel * reflect_direction(normalize(boundary.v), passage.normal));
    branch_from(state, (volume.world_from_voxel * vec4(began, 1.0)).xyz, way, reflected, state.mark);
    state.path.transmittance *= 1.0 - passage.reflectance;
}

// In dispersive volumes every colour takes its own path. This path continues with green; red and blue branch off.
void part_colors(inout PathState state) {
    for (uint other = 1u; other <= 3u; other += 2u) {
        vec3 only = vec3(other == 1u, 0.0, other == 3u);
        branch_from(state, state.path.position, state.path.direction, only * state.path.transmittance,
                    (state.mark & ~kChannelMask) | other);
    }
    state.mark = (state.mark & ~kChannelMask) | 2u;
    state.path.transmittance *= vec3(0.0, 1.0, 0.0);
}

// Moves a ray that entered through the mesh past the smoothed surface along `direction`. The voxels would otherwise
// repeat the mesh's interface. In a thin wall the other side may begin before.
void pass_entry(inout CurvedRay ray, vec3 direction) {
    float lowest = 1.0;
    for (uint k = 0u; k < 64u; ++k) {
        float boundary = volume_value(volume_absorption, ray.x).a;
        if (boundary <= kBoundaryEnds || boundary > lowest + 0.1) break;
        lowest = min(lowest, boundary);
        ray.x += 0.25 * direction;
    }
}

// Returns false if the path ends because it has run out of steps.
bool march(ivec2 texel, uint own, bool from_mesh, inout PathState state) {
    VolumeRecord volume = volumes[own];
    if (kDisperses && (volume.flags & kDispersiveVolume) != 0u && !has_mark(state, kChannelMask)) part_colors(state);
    enter_volume(volume, state.mark & kChannelMask);
    mat3 world_from_voxel = mat3(volume.world_from_voxel) / volume.voxel;
    CurvedRay ray;
    ray.x = clamp(voxel_position(volume, state.path.position), vec3(0.0), volume.size);
    ray.v = voxel_direction(volume, state.path.direction);
    bool is_held = proxy == kSharpInterfaces && (volume.flags & kMeshVolume) != 0u;
    bool has_mesh = proxy == 1u && (volume.flags & kMeshVolume) != 0u;
    if (kSurfacesInside && has_mesh && from_mesh) pass_entry(ray, ray.v);
    float n_entry = index_field(ray.x).w;
    ray.v *= n_entry;
    Boundary boundary = kNoBoundary;
    vec3 boundary_began = ray.x;

    // Surfaces of objects are searched straight ahead, and again once the ray has turned. The sooner it turned, the
    // shorter the next search.
    float until_surface = kFarthest, since_look = 0.0, reach = kFarthest;  // in voxels
    vec3 looked_along = vec3(0.0);
    float t_min = -coincidence, short_of = 0.5 * kApart * coincidence / volume.voxel;
    uint steps = 0u;
    Search search;
    begin_search(state.media, state.standing, state.pixel, search);
    search.most_visits = min(kMostVisits, (kMostTurns - min(kMostSteps, 60000u)) / (kTogether * kTurnsPerVisit));
    bool inside = true;
    bool in_air = has_mesh && !from_mesh;  // in air inside the box, where the mesh gives the ray's next surface
    for (; inside && steps < kMostSteps; ++steps) {
        CurvedRay next;
        float near, share;
        vec3 direction = normalize(ray.v);
        // In uniform regions a step reaches the next possible change.
        float stride = kStep;
        if (!kOverlapping && !(kScatters && kLit) && !boundary.open) stride = max(stride, even_way(ray.x, direction));
        if (kSurfacesInside) {
            bool turned = dot(direction, looked_along) < kStraight || (until_surface < kStep && direction != looked_along);
            if (in_air || turned || since_look + kStep > reach) {
                if (in_air) reach = kFarthest;
                else if (looked_along != vec3(0.0)) reach = kReachGrows * max(since_look, max(kStep, 1.0));
                search.limit = min(reach * volume.voxel, kFarthest);
                search.replaced = in_air ? kMeetAll : has_mesh || proxy == 0u ? kMeetNone : kMeetEntering;
                SurfaceHit hit = find_surface_among_objects((volume.world_from_voxel * vec4(ray.x, 1.0)).xyz,
                                                            world_from_voxel * direction, t_min, search);
                if (search.gave_up) steps = kMostSteps;
                t_min = 0.0;
                since_look = 0.0;
                until_surface = hit.t < kFarthest ? max(hit.t, 0.0) / volume.voxel : kFarthest;
                looked_along = direction;
                // A surface hit from inside belongs to a hollow. The voxels of its other side bend the ray.
                if (in_air && hit.t < kFarthest && hit.leaving && (hit.traits & kReplaced) != 0u) {
                    in_air = false;
                    looked_along = vec3(0.0);
                    until_surface = kFarthest;
                }
            }
            stride = min(stride, max(reach - since_look, kStep));
            float to_surface = max(until_surface - short_of, 0.0);
            if (in_air) {
                clip_to_box(volume, ray.x, direction, near, share);
                next.x = ray.x + clamp(to_surface, 0.0, max(share, 0.0)) * direction;
                state.path.length_inside += distance(next.x, ray.x) * volume.voxel;
                ray = CurvedRay(next.x, ray.v);
                break;
            }
            inside = until_surface > stride;
            if (!inside) stride = to_surface;
            until_surface -= stride;
            since_look += stride;
        }
        next = space_step(kIntegrator, ray, stride);
        // end straight on the surface, with the direction of the curve
        if (!inside) next.x = ray.x + stride * direction;
        vec3 way = next.x - ray.x;
        clip_to_box(volume, ray.x, way, near, share);
        if (share < 1.0) {
            inside = false;
            way *= share;
            next = CurvedRay(ray.x + way, mix(ray.v, next.v, share));
        }
        float travelled = length(way);
        state.path.length_inside += travelled * volume.voxel;
        vec3 middle = ray.x + 0.5 * way;
        vec4 absorption = vec4(0.0);
        vec4 scattering = vec4(0.0);
        if (kAbsorbs || kBoundaries) absorption = volume_value(volume_absorption, middle);
        if (kScatters) scattering = volume_value(volume_scattering, middle);
        vec3 depth = (absorption.rgb + scattering.rgb) * travelled, left = exp(-depth);
        if (kEmits || (kScatters && kLit)) {
            vec3 added = vec3(0.0);  // radiance per voxel length
            if (kEmits) added += drawn(part_met(state.mark), volume_value(volume_emission, middle).rgb);
            if (kScatters && kLit)
                added += drawn(part_through(state.mark, PELLUCID_DIRECT), scattered_radiance(own, middle, -normalize(ray.v), scattering));
            // L / n^2 is constant along a bent ray (the paper omits this).
            add_light(texel, state.mark, state.path.transmittance * mean_transmittance(depth) * (n_entry * n_entry / dot(ray.v, ray.v)) * added * travelled);
        }
        state.path.transmittance *= left;
        if (kBoundaries && !is_held) {
            if (passes_boundary(boundary, absorption.a, inside)) {
                boundary.open = false;
                leave_boundary(state, boundary, boundary_began, next.x, next.v, volume, world_from_voxel);
            }
            if (absorption.a > kBoundaryEnds && !boundary.open) {
                boundary = open_boundary(ray.x, ray.v, absorption.a);
                boundary_began = ray.x;
            }
            in_air = kSurfacesInside && has_mesh && absorption.a <= kBoundaryEnds && dot(next.v, next.v) < kAirIndex * kAirIndex;
        }
        ray = next;
        if (kOverlapping && inside && inside_smaller(own, (volume.world_from_voxel * vec4(ray.x, 1.0)).xyz)) inside = false;
    }
    state.path.position = (volume.world_from_voxel * vec4(ray.x, 1.0)).xyz;
    state.path.direction = normalize(world_from_voxel * ray.v);
    state.mark = after_surface(state.mark | kCrossedVolume, false);
    return steps < kMostSteps || !inside;
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    PathState state;
    load_path(i, 0u, state);
    state.mark &= ~kEntersVolume;
    bool from_mesh = in_replaced(filling_body(state.media));
    if (from_mesh && proxy != kSharpInterfaces) {
        clear_media(state.media);  // from here on the volume determines the medium
        state.standing = PELLUCID_NO_TRIANGLE;
    }
    float straight;
    uint own = next_volume(state.path.position, state.path.direction, volumes_of(from_mesh, proxy), straight);
    bool goes_on = own == kNoVolume || march(texel, own, from_mesh, state);
    if (!goes_on) state.path.status = kStatusStepLimit;
    save_path(state);
    if (goes_on) append_next(texel);
    else append_ended(texel);
}
