#ifndef PELLUCID_OPTICS_TRANSMITTANCE_GLSL
#define PELLUCID_OPTICS_TRANSMITTANCE_GLSL

// Mean over a way of even medium of what has got so far, where `depth` is the optical depth of all of it.
vec3 mean_transmittance(vec3 depth) {
    vec3 mean = (1.0 - exp(-depth)) / max(depth, 1e-4);
    return mix(mean, 1.0 - 0.5 * depth, lessThan(depth, vec3(1e-3)));
}

#endif
