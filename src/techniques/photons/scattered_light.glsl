#ifndef PELLUCID_TECHNIQUES_PHOTONS_SCATTERED_LIGHT_GLSL
#define PELLUCID_TECHNIQUES_PHOTONS_SCATTERED_LIGHT_GLSL

// Photons of emissive surfaces and of the environment. Each has its own direction, aimed at the sphere around all
// targets. Needs: gpu/frame.glsl, light/photon_windows.glsl, sent_light.glsl, gpu/light_sample.glsl, emitters.glsl,
// gpu/environment_lookup.glsl.
#include "gpu/environment_shares.glsl"
#include "gpu/hash.glsl"

// Random number k < 5 of photon `number`, in [0, 1): Roberts' additive recurrence in six dimensions ("The unreasonable
// effectiveness of quasirandom sequences", 2018), with a new offset in every sample.
float photon_number(uint number, uint k) {
    const uint kSteps[5] = uint[5](0xe60e2b73u, 0xcebd76d9u, 0xb9c9aa3bu, 0xa6f5777fu, 0x9609c71fu);
    return float((number * kSteps[k] + hash(uvec3(frame.sample_index, k, 17u)).x) >> 8u) / 16777216.0;
}

vec2 photon_numbers(uint number, uint k) { return vec2(photon_number(number, k), photon_number(number, k + 1u)); }

// Samples a photon of an emissive surface. `standing`: the triangle that the photon leaves.
SentLight light_of_emitter(PhotonWindow window, uint number, float count, out uint standing) {
    EmitterPoint point = emitter_point(photon_numbers(number, 0u), photon_number(number, 2u));
    vec3 to_targets = window.light.position - point.position;
    float distance_ = length(to_targets), sine;
    bool within = distance_ <= window.light.radius;
    float height = within ? 2.0 : one_minus_cos(window.light.radius / distance_), solid_angle = 6.283185307 * height;
    SentLight sent;
    sent.origin = point.position;
    sent.direction = sample_cone(within ? point.outward : to_targets / distance_, height, photon_numbers(number, 3u), sine);
    sent.flux = point.emission * (emission_cosine(point, sent.direction) * solid_angle / (point.density * count));
    sent.spacing = vec2(inversesqrt(point.density * count), sqrt(solid_angle / count));
    standing = point.triangle;
    return sent;
}

// Samples a photon of the environment. It starts outside the scene, on a disc perpendicular to its direction that
// covers the targets.
SentLight light_of_environment(PhotonWindow window, uint number, float count) {
    float pdf, radius = window.light.radius, area = 3.14159265 * radius * radius;
    vec3 to_light = sample_environment(photon_numbers(number, 0u), pdf);
    vec2 u = photon_numbers(number, 2u);
    vec2 disc = radius * sqrt(u.x) * vec2(cos(6.283185307 * u.y), sin(6.283185307 * u.y));
    SentLight sent;
    sent.origin = window.light.position + tangent_frame(to_light) * vec3(disc, window.target_depth);
    sent.direction = -to_light;
    sent.flux = environment_radiance(to_light) * (area / (pdf * count));
    sent.spacing = vec2(sqrt(area / count), inversesqrt(pdf * count));
    return sent;
}

#endif
