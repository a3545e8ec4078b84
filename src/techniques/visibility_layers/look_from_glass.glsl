#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_FROM_GLASS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_FROM_GLASS_GLSL

// Light of lights at a rough boundary of glass, on either side. A shadow ray aims at one of them, and another goes where the path
// goes if a light lies there; the power heuristic combines both. The path itself sees no lights up to the next boundary.
// Needs: cross_boundary.glsl as far as struct Meeting.
#include "gpu/light_parts.glsl"
#include "techniques/visibility_layers/facet_scattering.glsl"
#include "techniques/visibility_layers/shadow_rays.glsl"

// Facets so rough leave emissive surfaces to shadow rays. Those that are smoother meet them by chance. Nothing combines both: where a
// path ends, nobody knows any more how likely its direction was.
const float kLooksAtEmitters = 0.3;

bool looks_at_emitters(PathState state, float roughness) {
    return emitter_count > 0u && roughness >= kLooksAtEmitters && !has_mark(state, kBounced | kFromDiffuse);
}

// Lights, and emissive surfaces as one more.
uint sources_from_glass(PathState state, float roughness) {
    return direct_lights + (looks_at_emitters(state, roughness) ? 1u : 0u);
}

// Whether shadow rays bring the light of lights to such a boundary. Photons bring it to diffuse surfaces, and straight shadow rays
// that glass lets pass.
bool glass_looks(PathState state, float roughness, float eta) {
    if (!kRough || !kLightsSurfaces || kFromLight || sources_from_glass(state, roughness) == 0u) return false;
    bool brought = has_mark(state, kFromDiffuse) && (kPhotons || tinted_shadows != 0u);
    bool only_looks_ahead = kGathers && has_mark(state, kMainPath);
    return roughness > 0.0 && eta != 1.0 && !brought && !only_looks_ahead;
}

// Where a lobe stands for facets, those that the path has met before widen it. `bending`: of a facet's tilt.
float looking_alpha(PathState state, float roughness, float bending) {
    float alpha = facet_alpha(roughness);
    return samples_facets() ? alpha : min(length(vec2(alpha, spread_of(state.mark) / bending)), 1.0);
}

// Whether a direction leads to the side of the triangle to which the interpolated normal says it does.
bool sides_agree(Crossing crossing, vec3 direction, vec3 wi) { return leads_through(crossing, direction) == (wi.z < 0.0); }

vec3 scattered_light(Crossing crossing, Meeting m, vec3 wo, vec3 wi) {
    vec3 tint = wi.z < 0.0 ? m.tint : vec3(1.0);
    bool apart = m.channel == 0u && (refracts_apart(crossing.n_i) || refracts_apart(crossing.n_t));
    if (!apart) return m.carried * tint * facet_scattering(wo, wi, m.eta, m.lobe);
    for (uint c = 0u; c < 3u; ++c) tint[c] *= facet_scattering(wo, wi, crossing.n_i[c] / crossing.n_t[c], m.lobe);
    return m.carried * tint;
}

// Glass blocks what comes to a path inside of it from infinity.
bool can_arrive(PathState state, float distance_) { return distance_ < kFarLight || filling_body(state.media) == kAir; }

// Sends a shadow ray to one light, chosen by about what it contributes unshadowed.
void look_from_glass(PathState state, Crossing crossing, Meeting m) {
    if (!draws_part(part_met(state.mark))) return;
    vec3 wo = -m.incident * m.lobe.world_from_surface, wi;
    LightSample light;
    float sum = 0.0, share = 0.0, density, pdf;
    for (uint i = 0u; i < m.sources; ++i) {
        LightSample seen = sample_source(i, state.path, hash(uvec3(state.seed, 5003u + i, 0u)).x);
        vec3 to_light = seen.to_light * m.lobe.world_from_surface;
        float stand_in = stand_in_density(wo, to_light, m.eta, m.lobe.alpha), contribution = largest(seen.irradiance) * stand_in;
        sum += contribution;
        if (!(next_random(m.lobe) * sum < contribution)) continue;
        light = seen;
        wi = to_light;
        share = contribution;
        density = stand_in;
        pdf = i < direct_lights ? light_density(scene_lights[i], state.path.position) : 0.0;
    }
    if (!(share > 0.0) || !sides_agree(crossing, light.to_light, wi)) return;
    state.path.direction = light.to_light;
    settle(state, crossing);
    if (!can_arrive(state, light.distance_)) return;
    vec3 weight = scattered_light(crossing, m, wo, wi) * light.irradiance * (sum / share);
    if (samples_facets() && pdf > 0.0) weight *= power_heuristic(pdf, density);
    if (!(largest(weight) > 0.0)) return;
    state.mark |= kFromGlass;
    if (crossing.first && wi.z > 0.0) state.mark |= kOuterBranch;
    push_shadow_ray(state, light, weight);
}

// Leaves the lights in the direction of a path to a shadow ray.
void leave_lights(inout PathState state, Crossing crossing, Meeting m) {
    vec3 wi = state.path.direction * m.lobe.world_from_surface;
    if (!sides_agree(crossing, state.path.direction, wi)) return;  // shadow rays do not look there
    state.mark |= kFromGlass;
    if (m.sources > direct_lights) state.mark |= kUnbent;
    if (!samples_facets() || !draws_part(part_met(state.mark))) return;
    float density = 0.0;
    for (uint i = 0u; i < kVisibleLights; ++i) {
        float distance_;
        vec3 radiance = light_ahead(scene_lights[i], state.path.position, state.path.direction, distance_);
        if (radiance == vec3(0.0) || !can_arrive(state, distance_)) continue;
        if (density == 0.0)
            density = stand_in_density(-m.incident * m.lobe.world_from_surface, wi, m.eta, m.lobe.alpha);
        float weight = power_heuristic(density, light_density(scene_lights[i], state.path.position));
        push_shadow_ray(state, LightSample(state.path.direction, distance_, vec3(0.0)), state.path.transmittance * radiance * weight);
    }
}

#endif
