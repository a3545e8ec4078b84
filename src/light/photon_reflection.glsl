#ifndef PELLUCID_LIGHT_PHOTON_REFLECTION_GLSL
#define PELLUCID_LIGHT_PHOTON_REFLECTION_GLSL

// What an opaque surface reflects of photons.
// Needs: gpu/opaque_surface.glsl, gpu/octahedral.glsl, kFullLight.
#include "light/photons.glsl"

struct PhotonReceiver {
    bool reflects;          // the sum is radiance to the viewer; otherwise irradiance, W/m2
    OpaqueSurface surface;
    vec3 normal;            // unit, interpolated
    vec3 to_viewer;         // unit
};

// A receiver that sums irradiance. Its other members are not read.
PhotonReceiver irradiance_alone() {
    PhotonReceiver receiver;
    receiver.reflects = false;
    return receiver;
}

// Highlights of photons in smooth coats are cut off, so that sums fit; 1/sr.
const float kMostReflected = 1024.0;

// Over the photon's irradiance. Photons count across the triangle, the BRDF with the interpolated normal.
vec3 photon_reflection(Photon photon, PhotonReceiver receiver) {
    if (!receiver.reflects) return vec3(1.0);
    vec3 to_light = -unpack_unit_vector(photon.way);
    OpaqueSurface surface = receiver.surface;
    if (kFullLight && (photon.way & kDiffusePhoton) != 0u) surface = without_lobes(surface);
    float cosine = max(dot(unpack_unit_vector(photon.normal), to_light), 1e-3);
    return min(opaque_reflection(surface, receiver.normal, receiver.to_viewer, to_light) / cosine, vec3(kMostReflected));
}

#endif
