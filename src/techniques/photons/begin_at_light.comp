#version 460
// Photons at their light: one per texel of a light's view. All texels of a frame have the same jitter.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
layout(constant_id = 6) const uint kEnvironmentKind = 0u;
#define PELLUCID_ENVIRONMENT_KIND kEnvironmentKind
layout(set = 0, binding = 55) uniform texture2D environment_map;
#include "gpu/vertices.glsl"
#include "techniques/visibility_layers/path_walk.glsl"
#include "gpu/environment_lookup.glsl"
#include "light/photon_windows.glsl"
#include "light/photons.glsl"
#include "gpu/light_sample.glsl"
#include "techniques/visibility_layers/emitters.glsl"
#include "techniques/photons/sent_light.glsl"
#include "techniques/photons/scattered_light.glsl"
layout(std430, set = 0, binding = 53) buffer Photons { uint photon_count, photon_reserved[3]; Photon photons[]; };
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

// The sequence R2, 0..1: Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018.
vec2 jitter_of(uint sample_index) {
    return vec2(uvec2(sample_index + 1u) * uvec2(3242174889u, 2447445414u)) / 4294967296.0;
}

// A point of the unit disc; points of neighbouring texels are well distributed.
vec2 disc_point(uvec2 texel, uint sample_index) {
    vec2 u = fract(vec2(texel) * mat2(0.7548776662, 0.5698402910, 0.8191725134, 0.6710436067) +
                   vec2(hash(uvec3(sample_index, 5u, 9u)).xy >> 8u) / 16777216.0);
    return sqrt(u.x) * vec2(cos(6.283185307 * u.y), sin(6.283185307 * u.y));
}

// Lists a photon at its start, to sum the emitted flux of sources that the host cannot compute.
void count_sent(ivec2 texel, vec3 flux) {
    uint number = atomicAdd(photon_count, 1u);
    if (number >= uint(photons.length())) return;  // the count then exceeds the capacity, and the frame is repeated
    photons[number] = Photon(vec3(0.0), 0.0, flux, 0u, kStraightPhoton, kNotYetLanded, list_word(texel), 0u);
}

// The light sent through a texel of a window. `standing`, `mark`: state of its path.
SentLight light_of_texel(PhotonWindow window, uvec2 within, out uint standing, out uint mark) {
    float count = float(window_side * window_side);
    uint number = within.y * window_side + within.x;
    standing = PELLUCID_NO_TRIANGLE;
    mark = 0u;
    if (window.source == kFromEmitters) {
        mark = kBounced;  // neighbouring triangles continue the emitting surface
        return light_of_emitter(window, number, count, standing);
    }
    if (window.source == kFromEnvironment) {
        mark = kUnbent;
        return light_of_environment(window, number, count);
    }
    return sent_light(window, vec2(within) + jitter_of(frame.sample_index), disc_point(within, frame.sample_index));
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    uint number = uint(texel.y) * frame.width + uint(texel.x), window;
    uvec2 within;
    waiting[number] = uvec2(0u);
    if (!window_of(texel, window, within)) return;
    PathState state;
    SentLight sent = light_of_texel(windows[window], within, state.standing, state.mark);
    if (!(max(sent.flux.r, max(sent.flux.g, sent.flux.b)) > 0.0)) return;
    if (lists_straight != 0u && windows[window].source != kFromLights) count_sent(texel, sent.flux);
    state.path = Path(sent.origin, normalize(sent.direction), sent.flux, 0.0, 0u, 0u, kStatusOk, false);
    set_photon_spacing(state.path, sent.spacing);
    clear_media(state.media);
    if (eye_differs != 0u && !kFoundOnHost) find_media(state.path.position, state.path.direction, state.media);
    state.pixel = number;
    save_path(state);
    append_next(texel);
}
