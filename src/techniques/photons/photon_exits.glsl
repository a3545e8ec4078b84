#ifndef PELLUCID_TECHNIQUES_PHOTONS_PHOTON_EXITS_GLSL
#define PELLUCID_TECHNIQUES_PHOTONS_PHOTON_EXITS_GLSL

// Photons where they leave the glass, per texel of the lights' windows.
struct PhotonExit {
    vec3 position;   // m, world
    uint events;     // 0: there is none
    vec3 direction;  // unit
    float spacing;   // m, of photons as they meet the glass
    vec3 flux;       // W
    float reserved;
};
layout(std430, set = 0, binding = 54) buffer PhotonExits { PhotonExit exits[]; };

#endif
