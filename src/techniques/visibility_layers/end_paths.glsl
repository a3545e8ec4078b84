#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_END_PATHS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_END_PATHS_GLSL

// Paths that have come to their end: what light comes from there; then the pixel's next branch, if one waits.
// Programs that define PELLUCID_LIT shine lights (lights_on_surfaces.glsl) on opaque surfaces, too.
#include "techniques/visibility_layers/visibility_bindings.glsl"

layout(constant_id = 6) const uint kEnvironmentKind = 0u;
layout(constant_id = 7) const bool kOpaqueObjects = false;  // there are some
layout(constant_id = 61) const bool kFinishes = false;      // see gpu/opaque_surface.glsl
#define PELLUCID_ENVIRONMENT_KIND kEnvironmentKind

layout(std430, set = 0, binding = 3) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 4) uniform texture2DArray texture_pages;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2DArray exit_position;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image2DArray transmittance;
layout(set = 0, binding = 14, r32ui) writeonly uniform uimage2DArray path_events;
layout(set = 0, binding = 15) uniform texture2D environment_map;
layout(set = 0, binding = 16) uniform texture2D filtered_environment;
#include "gpu/object_traits.glsl"
layout(std430, set = 0, binding = 17) readonly buffer Appearance { float appearance[]; };
layout(std430, set = 0, binding = 64) readonly buffer Finishes { FinishRecord finishes[]; };
layout(std430, set = 0, binding = 65) readonly buffer Tangents { uint tangents[]; };
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

#include "gpu/appearance.glsl"
#include "gpu/coverage.glsl"
#include "gpu/vertices.glsl"
#include "techniques/visibility_layers/path_state.glsl"
layout(std430, set = 0, binding = 44) readonly buffer Slots { SlotRecord slots[]; };
#include "techniques/visibility_layers/filling_body.glsl"
#include "techniques/visibility_layers/path_light.glsl"
#include "techniques/visibility_layers/microfacets.glsl"
#include "gpu/opaque_surface.glsl"
#include "gpu/octahedral.glsl"
#include "light/photon_reflection.glsl"
#include "light/photon_lookup.glsl"
#include "light/photon_mirrors.glsl"
#ifdef PELLUCID_LIT
#include "techniques/ihrke_2007/lights_on_surfaces.glsl"
#endif

#include "techniques/visibility_layers/opaque_point.glsl"

// Whether photons have brought the light of emissive surfaces and the environment that such a path meets by chance.
bool photons_have(PathState state) { return has_mark(state, kFromDiffuse) && !has_mark(state, kUnbent); }

// Whether photons bring what the point's facets throw on the diffuse surface from which the path has come.
bool mirrors_photons(PathState state, OpaquePoint point) { return point.reflects_photons && has_mark(state, kFromDiffuse); }

// Of an opaque surface, what it reflects of an environment that nothing hides, and what it emits. Paths carry
// radiance over n^2: what a surface emits into a medium, and what lamps in it throw, is divided by that.
vec3 light_of(PathState state, OpaquePoint point) {
    uint met = part_met(state.mark), scattered = part_through(state.mark, PELLUCID_DIRECT);
    if (point.unlit) return drawn(met, point.emission);
    // Shadow rays have brought what is met straight from an opaque surface.
    bool emits = emitter_count == 0u || !(has_mark(state, kUnbent) || (kPhotonsOfEmitters && has_mark(state, kFromDiffuse)));
    vec3 emission = emits ? drawn(met, point.emission / (point.ior * point.ior)) : vec3(0.0);
    if (kPhotonsOfEnvironment && mirrors_photons(state, point)) {
        return drawn(scattered, opaque_diffuse_radiance(point.surface, point.normal, -state.path.direction)) + emission;
    }
    return opaque_radiance(point.surface, point.normal, -state.path.direction, scattered, part_met(after_surface(state.mark, false))) + emission;
}

#include "techniques/visibility_layers/look_at_lights.glsl"
#include "techniques/visibility_layers/bounces.glsl"

#include "gpu/background.glsl"

// What the environment sends along a path, or what the caller has drawn before it.
vec3 environment_light(PathState state) {
    // Glass that lets shadow rays pass bends none of this light.
    bool bent_elsewhere = kPhotonsOfEnvironment || (kEnvironmentRays && tinted_shadows != 0u);
    if ((bent_elsewhere && photons_have(state)) || shadow_rays_have(state)) return vec3(0.0);
    vec3 direction = state.path.direction, seen;
    if (kBackground && background_ahead(state.path.position, direction, seen)) return state.path.transmittance * seen;
    // What glass and mirrors throw on a diffuse surface is sharp.
    if (has_mark(state, kBounced) && !has_mark(state, kUnbent)) return state.path.transmittance * environment_radiance(direction);
    float spread = kRough || has_mark(state, kBounced) ? spread_of(state.mark) : 0.0;
    if (spread > 0.0) return state.path.transmittance * filtered_environment_radiance(direction, sqrt(spread));
    bool sees_suns = !(kPhotons && has_mark(state, kFromDiffuse)) && !has_mark(state, kFromGlass);
    vec3 suns = sees_suns ? suns_ahead(direction) : vec3(0.0);
    return state.path.transmittance * (environment_radiance(direction) + suns);
}

void store_result(ivec2 texel, PathState state) {
    ivec3 at = ivec3(texel, 0);
    Path path = state.path;
    float object = has_mark(state, kMetOpaque) ? float(object_of(state.standing)) : kEndsInEnvironment;
    imageStore(exit_direction, at, vec4(path.direction, path.length_inside));
    imageStore(exit_position, at, vec4(path.position, object));
    imageStore(transmittance, at, vec4(path.transmittance, has_mark(state, kFromGlass) ? 0.0 : 1.0));
    // A path that has crossed a volume without a surface has met something, too.
    if (kVolumes && has_mark(state, kCrossedVolume)) path.events = max(path.events, 1u);
    imageStore(path_events, at, uvec4(pack_events(path)));
}

// Takes a path on from a hole in an opaque surface.
void pass_hole(ivec2 texel, PathState state) {
    state.mark &= ~kMetOpaque;
    save_path(state);
    append_next(texel);
}

// What photons have brought to the surface; where lights shine through volumes, what these bring, too.
void add_stored_light(ivec2 texel, PathState state, OpaquePoint point, bool rasterised) {
    if (point.unlit) return;
    vec3 light = vec3(0.0), to_viewer = -state.path.direction;
#ifdef PELLUCID_LIT
    if (!rasterised)
        light = drawn(part_through(state.mark, PELLUCID_DIRECT),
                      diffuse_albedo(point, to_viewer) * irradiance_of_lights(state.path.position, point.normal) / 3.14159265);
#else
    if (kPhotons)
        light = drawn(part_through(state.mark, PELLUCID_CAUSTIC),
                      photon_light(state.path.position, point.normal, PhotonReceiver(true, point.surface, point.normal, to_viewer)));
#endif
    add_light(texel, state.mark, state.path.transmittance * light / (point.ior * point.ior));
}

// Ends a path at an opaque surface. False: there is a hole.
bool end_at_surface(ivec2 texel, PathState state) {
    OpaquePoint point = opaque_point(state);
    if (point.alpha < 0.0) return false;
    if (kLightsSurfaces && has_mark(state, kToLight)) return true;  // the surface is in the light's way
    if (kGathers && has_mark(state, kMainPath)) {
        gather(texel, state, point);
        return true;
    }
    bool rasterised = has_mark(state, kOpaquePixel) && has_mark(state, kMainPath);
    if (!rasterised && has_mark(state, kMainPath)) store_result(texel, state);
    if (!rasterised) add_light(texel, state.mark, state.path.transmittance * light_of(state, point));
    add_stored_light(texel, state, point, rasterised);
    // Light that goes through translucent surfaces is drawn with them (shade/transmit_light.comp), and what they reflect.
    CachedLight known = kNoCachedLight;
    if (kFullLight && !point.unlit) known = light_around(texel, state, point);
    if (kLightsSurfaces && !point.unlit && !(rasterised && point.translucent)) look_at_lights(texel, state, point, known.open);
    if ((kTree || kFullLight) && most_bounces > 0u && !(rasterised && !kFullLight)) bounce(texel, state, point, known);
    return true;
}

// Ends a path that has met no opaque surface.
void end_in_the_open(ivec2 texel, PathState state) {
    if (kLightsSurfaces && has_mark(state, kToLight)) {
        if (closing != 0u || state.path.status == kStatusEventLimit) return;
        float ior = filling_iors(filling_body(state.media)).g;
        add_light(texel, state.mark, state.path.transmittance / (ior * ior));
        return;
    }
    if (kGathers && has_mark(state, kMainPath)) return;
    if (closing != 0u && has_mark(state, kMainPath)) state.path.status = kStatusEventLimit;
    if (has_mark(state, kMainPath)) store_result(texel, state);
    if (kVisibleLights > 0u && has_mark(state, kMetLamp)) {
        float ior = filling_iors(filling_body(state.media)).g;
        add_light(texel, state.mark, drawn(part_met(state.mark), state.path.transmittance / (ior * ior)));
        return;
    }
    if (kTree || kStochastic || whole_picture != 0u || !has_mark(state, kMainPath))
        add_light(texel, state.mark, drawn(part_met(state.mark), environment_light(state)));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    PathState state;
    load_path(i, 0u, state);
    if (kOpaqueObjects && closing == 0u && has_mark(state, kMetOpaque)) {
        if (!end_at_surface(texel, state)) {
            pass_hole(texel, state);
            return;
        }
    } else {
        end_in_the_open(texel, state);
    }
    if (closing != 0u) {
        while (pop_branch(state)) end_in_the_open(texel, state);
    } else if (pop_branch(state)) {
        save_path(state);
        append_next(texel);
    }
}

#endif
