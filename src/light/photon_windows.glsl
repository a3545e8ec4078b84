#ifndef PELLUCID_LIGHT_PHOTON_WINDOWS_GLSL
#define PELLUCID_LIGHT_PHOTON_WINDOWS_GLSL

// The views from which lights emit photons, as windows of one image. A window has `side` by `side` texels, and a row
// has `columns` windows. A window of emissive surfaces or the environment is no view, but emits as many photons. Needs:
// gpu/structs.h.
#include "gpu/punctual_light.glsl"

// Twins of PhotonWindow::Source.
const uint kFromLights = 0u, kFromEmitters = 1u, kFromEnvironment = 2u;

// Twin of PhotonWindow in photon_windows.h.
struct PhotonWindow {
    mat4 world_from_view;
    vec4 film;  // see FrameConstants::film
    PunctualLight light;  // kFromEmitters, kFromEnvironment: position and radius of the sphere around all targets
    uint orthographic;
    float target_depth;  // depth of the targets' centre, m; kFromEnvironment: distance from there to beyond the scene
    uint source;         // kFromLights, ...
    uint reserved0;
};
layout(std430, set = 0, binding = 50) readonly buffer PhotonWindows {
    uint window_side, window_columns, window_count;
    float kernel_width;  // radius of kernels, in spacings of photons
    float least_radius;  // of kernels, m
    uint lists_straight; // 1: photons of straight paths are listed, too
    uint window_reserved0, window_reserved1;
    PhotonWindow windows[];
};

// The window of a texel. `within`: texel within the window. False if no window has this texel.
bool window_of(ivec2 texel, out uint window, out uvec2 within) {
    uvec2 at = uvec2(texel) / window_side;
    window = at.y * window_columns + at.x;
    within = uvec2(texel) % window_side;
    return at.x < window_columns && window < window_count;
}

#endif
