#ifndef PELLUCID_TECHNIQUES_PHOTONS_PHOTON_EXITS_GLSL
#define PELLUCID_TECHNIQUES_PHOTONS_PHOTON_EXITS_GLSL

// Photons at their exits from glass, per texel of the lights' windows.
struct PhotonExit {
    vec3 position;   // m, world
    uint events;     // 0: no photon
    vec3 direction;  // unit
    float spacing;   // m, spacing of photons at the entry into glass
    vec3 flux;       // W
    float reserved;
};
layout(std430, set = 0, binding = 54) buffer PhotonExits { PhotonExit exits[]; };

#endif
