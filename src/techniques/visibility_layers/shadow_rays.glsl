#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_SHADOW_RAYS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_SHADOW_RAYS_GLSL

// Targets of shadow rays. Needs: path_state.glsl, microfacets.glsl and the includes of emitters.glsl.
#include "techniques/visibility_layers/path_lights.glsl"
#include "techniques/visibility_layers/emitters.glsl"

// Number of sources: the lights, and one for all emissive surfaces together.
uint source_count() { return direct_lights + (emitter_count > 0u ? 1u : 0u); }

// A sampled point of source `number`, seen from the end of a path.
LightSample sample_source(uint number, Path path, uint seed) {
    vec2 u = spread_numbers(seed, path.events);
    if (number < direct_lights) return sample_light(scene_lights[number], path.position, u);
    return sample_emitter(path.position, u, random_number(seed, path.events));
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

#endif
