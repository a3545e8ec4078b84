#ifndef PELLUCID_OPTICS_TRANSMITTANCE_GLSL
#define PELLUCID_OPTICS_TRANSMITTANCE_GLSL

// Mean transmittance over a segment in a homogeneous medium, from its start to each of its points. `depth`: optical
// depth of the whole segment.
vec3 mean_transmittance(vec3 depth) {
    vec3 mean = (1.0 - exp(-depth)) / max(depth, 1e-4);
    return mix(mean, 1.0 - 0.5 * depth, lessThan(depth, vec3(1e-3)));
}

#endif
