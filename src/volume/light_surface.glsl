#ifndef PELLUCID_VOLUME_LIGHT_SURFACE_GLSL
#define PELLUCID_VOLUME_LIGHT_SURFACE_GLSL

// What surfaces in volumes reflect. A surface is as thick as the index is smoothed. Its normal is known once it lies
// behind: the direction in which v has changed; it and the indices on both sides say what it has reflected (Fresnel).
// Needs: gpu/octahedral.glsl.

#include "optics/interface.glsl"

const float kSurface = 0.25;      // boundary above which light is in a surface
const float kLeastTurn = 0.02;    // of v; less is no surface, or one beside the way of the light

// v in 31 bits: 11 and 10 of its direction (within 0.2 degrees), 10 of n up to 8 (within 0.004); never 0.
uint pack_incident(vec3 v) {
    vec2 place = clamp(octahedral_from_direction(v) * 0.5 + 0.5, 0.0, 1.0);
    return 1u << 31 | uint(place.x * 2047.0 + 0.5) << 20 | uint(place.y * 1023.0 + 0.5) << 10 |
           uint(clamp(length(v) * 128.0 + 0.5, 1.0, 1023.0));
}

vec3 unpack_incident(uint packed) {
    vec2 place = vec2(float(packed >> 20 & 0x7ffu) / 2047.0, float(packed >> 10 & 0x3ffu) / 1023.0);
    return normalize(octahedron_point(place * 2.0 - 1.0)) * float(packed & 0x3ffu) / 128.0;
}

// Share of the light that a surface has reflected: more than 0 in the step in which light leaves it. Light that it
// turns back (total reflection) loses nothing.
float crossed_surface(inout uint surface, float boundary, vec3 v_before, vec3 v_after) {
    if (boundary > kSurface) {
        if (surface == 0u) surface = pack_incident(v_before);
        return 0.0;
    }
    if (surface == 0u) return 0.0;
    vec3 v = unpack_incident(surface);
    surface = 0u;
    vec3 turned = v_after - v;
    if (length(turned) < kLeastTurn) return 0.0;
    vec3 incident = normalize(v), normal = normalize(turned);
    if (dot(incident, normal) > 0.0) normal = -normal;
    if (dot(v_after, normal) > 0.0) return 0.0;
    return fresnel_dielectric(-dot(incident, normal), length(v) / length(v_after));
}

#endif
