#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_AT_LIGHTS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_LOOK_AT_LIGHTS_GLSL

// Shadow rays from an opaque surface: branches of the path (path_state.glsl) that carry what the surface reflects of a
// light, and bring it if they reach the light.
// Needs: end_paths.glsl as far as struct OpaquePoint.
#include "techniques/visibility_layers/path_lights.glsl"
#include "techniques/visibility_layers/emitters.glsl"
#include "gpu/environment_shares.glsl"

// Shadow rays of one path end. Where there are more lights, they are chosen at random by what they contribute unshadowed.
const uint kMostShadowRays = 4u;

// Lights, and all that emits as one more.
uint source_count() { return direct_lights + (emitter_count > 0u ? 1u : 0u); }

// Light `number`'s sample at the end of a path, and what of it goes back along the path if nothing is in between.
vec3 unshadowed_light(uint number, ivec2 texel, PathState state, OpaquePoint point, out LightSample light) {
    uint seed = hash(uvec3(texel + first_pixel(), 4099u + number)).x;
    vec2 u = spread_numbers(seed, state.path.events);
    if (number < direct_lights) light = sample_light(scene_lights[number], state.path.position, u);
    else light = sample_emitter(state.path.position, u, random_number(seed, state.path.events));
    if (light.irradiance == vec3(0.0)) return vec3(0.0);
    OpaqueSurface surface = point.surface;
    // Photons bring what metal throws on the surface from which the path has come: here it counts as a perfect mirror.
    if (kPhotons && mirrors_photons(state, point) && (number < direct_lights || kPhotonsOfEmitters)) surface.roughness = 0.0;
    return state.path.transmittance * light.irradiance *
           opaque_reflection(surface, point.normal, -state.path.direction, light.to_light);
}

void push_shadow_ray(PathState state, LightSample light, vec3 weight) {
    state.mark = (state.mark & ~(kMainPath | kMetOpaque)) | kToLight;
    state.path.direction = light.to_light;
    state.path.transmittance = weight;
    state.path.length_inside = light.distance_;
    state.path.events = 0u;
    state.path.status = kStatusOk;
    push_branch(state, branch_capacity, false);
}

// What hides the environment from the diffuse layer: a direction chosen by its light. The environment has been counted as if
// nothing did, so a surface that stands alone has no noise.
void look_at_environment(ivec2 texel, PathState state, OpaquePoint point) {
    float pdf;
    uint seed = hash(uvec3(texel + first_pixel(), 4097u)).x;
    vec3 direction = sample_environment(spread_numbers(seed, state.path.events), pdf);
    float cosine = dot(point.normal, direction);
    if (!(cosine > 0.0) || !(pdf > 0.0)) return;
    vec3 weight = state.path.transmittance * diffuse_albedo(point, -state.path.direction) * environment_radiance(direction) *
                  (cosine / (3.14159265 * pdf));
    if (!(largest(weight) > 0.0) || !draws_part(part_through(state.mark, PELLUCID_DIRECT))) return;
    add_light(texel, state.mark, -weight);
    // Where the ray arrives, light is taken as that of a lamp in the medium.
    push_shadow_ray(state, LightSample(direction, kFarLight, vec3(0.0)), weight * (point.ior * point.ior));
}

void look_at_lights(ivec2 texel, PathState state, OpaquePoint point) {
    if (kEnvironmentRays) look_at_environment(texel, state, point);
    if (!draws_part(part_through(state.mark, PELLUCID_DIRECT))) return;
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
