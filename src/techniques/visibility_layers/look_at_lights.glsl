#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_AT_LIGHTS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_AT_LIGHTS_GLSL

// Shadow rays from an opaque surface: branches of the path (path_state.glsl) that carry what the surface reflects of a
// light, and bring it if they reach the light.
// Needs: end_paths.glsl as far as struct OpaquePoint.
#include "techniques/visibility_layers/shadow_rays.glsl"
#include "gpu/environment_shares.glsl"
#include "light/irradiance_lookup.glsl"

const uint kNeverCached = 8u;
layout(constant_id = 45) const uint kCachedFrom = kNeverCached;  // bounces after which the cache stands for those that follow
layout(constant_id = 46) const bool kEnvironmentRays = false;  // shadow rays find what hides the environment

// Shadow rays of one path end. Where there are more lights, they are chosen at random by what they contribute unshadowed.
const uint kMostShadowRays = 4u;

// Rays of one path end that look for the environment where part of it is hidden, and the shares between which it is.
const uint kMostSkyRays = 4u;
const float kHardlyOpen = 0.02, kHardlyHidden = 0.95;

// Light `number`'s sample at the end of a path, and what of it goes back along the path if nothing is in between.
vec3 unshadowed_light(uint number, ivec2 texel, PathState state, OpaquePoint point, out LightSample light) {
    light = sample_source(number, state.path, hash(uvec3(texel + first_pixel(), 4099u + number)).x);
    if (light.irradiance == vec3(0.0)) return vec3(0.0);
    OpaqueSurface surface = point.surface;
    // Photons bring what metal throws on the surface from which the path has come: here it counts as a perfect mirror.
    if (kPhotons && mirrors_photons(state, point) && (number < direct_lights || kPhotonsOfEmitters)) surface = without_lobes(surface);
    return state.path.transmittance * light.irradiance *
           opaque_reflection(surface, point.normal, -state.path.direction, light.to_light);
}

// A direction chosen by the environment's light.
struct SkyLook {
    vec3 direction;  // unit
    float cosine;    // to the normal; below 0: under the surface
    float pdf;       // per steradian; 0: there is none
};

SkyLook look_to_sky(ivec2 texel, PathState state, OpaquePoint point, uint number) {
    SkyLook look;
    uint seed = hash(uvec3(texel + first_pixel(), 4097u)).x;
    look.direction = sample_environment(spread_numbers(seed, state.path.events, number), look.pdf);
    look.cosine = dot(point.normal, look.direction);
    return look;
}

// Facets whose reflection of the environment shadow rays bring in stills that converge: their lobe is wide enough for directions that
// the environment chooses. Elsewhere one look-up stands for the lobe.
const float kWideAlpha = 0.25;

bool looks_by_facets(float roughness) { return kConverges && kEnvironmentRays && roughness * roughness >= kWideAlpha; }

// `weight`: what the ray brings if nothing hides the environment there.
void push_sky_ray(PathState state, SkyLook look, OpaquePoint point, vec3 weight) {
    // Where the ray arrives, light is taken as that of a lamp in the medium.
    push_shadow_ray(state, LightSample(look.direction, kFarLight, vec3(0.0)), weight * (point.ior * point.ior));
}

const float kStrongFacets = 0.1;  // Reflectance head-on from which facets need as many rays as what is partly hidden.

// What hides the environment from the surface. `open`: the share of its light that probably nothing hides. That much of what has
// been counted for the diffuse layer as if nothing did stays: a surface that is all open has no noise, and one that is all hidden has
// none. In stills that converge rays bring what the whole BRDF reflects, of which that is a good guess.
void look_at_environment(ivec2 texel, PathState state, OpaquePoint point, float open) {
    vec3 to_viewer = -state.path.direction, diffuse = state.path.transmittance * diffuse_albedo(point, to_viewer);
    OpaqueSurface surface = point.surface;
    bool facets = looks_by_facets(round_roughness(surface));
    vec3 by_rays = vec3(0.0);  // counted as if nothing hid the environment, and brought by the rays below
    if (facets) by_rays += opaque_facet_radiance(surface, point.normal, to_viewer);
    else surface = without_base_lobe(surface);
    if (kFinishes && kConverges) {
        if (has_sheen(surface)) by_rays += sheen_radiance(surface, point.normal, to_viewer);
        if (surface.layers.coat > 0.0 && looks_by_facets(surface.layers.coat_roughness)) by_rays += coat_radiance(surface, to_viewer);
        else surface.layers.coat_roughness = 0.0;
    }
    add_light(texel, state.mark, (open - 1.0) * diffuse * detailed_diffuse_radiance(point.normal) - state.path.transmittance * by_rays);
    bool noisy = (open > kHardlyOpen && open < kHardlyHidden) || (facets && largest(surface.at_normal) > kStrongFacets);
    uint rays = noisy ? kMostSkyRays : 1u;
    for (uint k = 0u; k < rays; ++k) {
        SkyLook look = look_to_sky(texel, state, point, rays * frame.sample_index + k);
        if (!(look.cosine > 0.0) || !(look.pdf > 0.0)) continue;
        vec3 light = environment_radiance(look.direction) / (look.pdf * float(rays));
        vec3 guess = diffuse * light * (look.cosine / 3.14159265), weight = guess;
        if (kConverges) weight = state.path.transmittance * light * opaque_reflection(surface, point.normal, to_viewer, look.direction);
        add_light(texel, state.mark, -open * guess);
        if (largest(weight) > 0.0) push_sky_ray(state, look, point, weight);
    }
}

// For the cache: whether the environment is open in a direction. The ray says it in `reflected_radiance`, next to the cosine.
void look_for_sky(ivec2 texel, PathState state, OpaquePoint point) {
    SkyLook look = look_to_sky(texel, state, point, frame.sample_index);
    if (!(look.cosine > 0.0) || !(look.pdf > 0.0)) return;
    imageStore(reflected_radiance, ivec3(texel, 0), vec4(0.0, 0.0, 0.0, look.cosine));
    state.mark |= kOuterBranch;
    push_sky_ray(state, look, point, vec3(1.0));
}

// What the cache knows of the surface. The environment that nothing hides was drawn by nine harmonics: what is missing of its
// detail is added.
CachedLight light_around(ivec2 texel, PathState state, OpaquePoint point) {
    vec3 diffuse = state.path.transmittance * diffuse_albedo(point, -state.path.direction);
    if (!(largest(diffuse) > 0.0)) return kNoCachedLight;
    vec3 light = detailed_diffuse_radiance(point.normal) - diffuse_radiance(vec3(1.0), point.normal);
    add_light(texel, state.mark, drawn(part_through(state.mark, PELLUCID_DIRECT), diffuse * light));
    if (kCachedFrom == kNeverCached) return kNoCachedLight;
    uint seed = hash(uvec3(texel + first_pixel(), 78u)).x;
    return cached_light(state.path.position, point.normal, random_number(seed, state.path.events));
}

void look_at_lights(ivec2 texel, PathState state, OpaquePoint point, float open) {
    if (!draws_part(part_through(state.mark, PELLUCID_DIRECT))) return;
    if (kEnvironmentRays) look_at_environment(texel, state, point, open);
    uint sources = source_count();
    bool chooses = sources > kMostShadowRays;
    float step_ = 0.0, next = 0.0, passed = 0.0;
    LightSample light;
    if (chooses) {
        for (uint i = 0u; i < sources; ++i) {
            vec3 weight = unshadowed_light(i, texel, state, point, light);
            step_ += (weight.r + weight.g + weight.b) / float(kMostShadowRays);
        }
        uint seed = hash(uvec3(texel + first_pixel(), 4098u)).x;
        next = step_ * random_number(seed, state.path.events);
    }
    for (uint i = 0u; i < sources; ++i) {
        vec3 weight = unshadowed_light(i, texel, state, point, light);
        float share = weight.r + weight.g + weight.b;
        if (!(share > 0.0)) continue;
        if (chooses) {
            passed += share;
            if (next >= passed) continue;
            float picks = floor((passed - next) / step_) + 1.0;
            next += picks * step_;
            weight *= picks * step_ / share;
        }
        push_shadow_ray(state, light, weight);
    }
}

#endif
