#ifndef PELLUCID_TECHNIQUES_REFRACTION_GLSL
#define PELLUCID_TECHNIQUES_REFRACTION_GLSL

// A path through the glass of one pixel, in view space, and the storage of its result. Needs: frame.glsl and the
// shared bindings of techniques (technique_bindings.glsl).
#include "optics/interface.glsl"

const uint kStatusOk = 0u;
const uint kStatusMissingLayer = 1u;
const uint kStatusLeftScreen = 2u;
const uint kStatusStepLimit = 3u;
const uint kStatusEventLimit = 4u;

const float kEndsInEnvironment = -1.0;  // twin in technique.h

struct Path {
    vec3 position;       // view space
    vec3 direction;      // unit
    vec3 transmittance;
    float length_inside;  // metres
    uint events;
    uint reflections;
    uint status;
    bool side_conflict;
};

Path camera_path(vec2 pixel) {
    Ray ray = camera_ray(pixel);
    return Path(ray.origin, ray.direction, vec3(1.0), 0.0, 0u, 0u, kStatusOk, false);
}

// Moves the path straight to a point inside a medium.
void travel(inout Path path, float distance, vec3 sigma_a) {
    path.position += distance * path.direction;
    path.length_inside += distance;
    path.transmittance *= beer_lambert(sigma_a, distance);
}

// Crosses the boundary of a solid of index `ior` with the outward `normal`, or reflects the path totally. Returns
// false under total internal reflection.
bool cross_interface(inout Path path, vec3 normal, bool leaving, float ior) {
    vec3 n = leaving ? -normal : normal;
    float eta = leaving ? ior : 1.0 / ior;
    float cos_theta_i = -dot(path.direction, n);
    // The interpolated normal bends the ray; the surface determines the side. If they disagree, the ray grazes.
    path.side_conflict = path.side_conflict || cos_theta_i < 0.0;
    ++path.events;
    vec3 incident = path.direction;
    if (refract_direction(incident, n, eta, path.direction)) {
        path.transmittance *= 1.0 - fresnel_dielectric(cos_theta_i, eta);
        return true;
    }
    ++path.reflections;  // refract_direction has written the reflected direction
    return false;
}

// Twin of unpack_events() in technique.h.
uint pack_events(Path path) {
    return min(path.events, 0xfffu) | min(path.reflections, 0xfffu) << 12 | path.status << 24 |
           (path.side_conflict ? 1u << 28 : 0u);
}

#endif
