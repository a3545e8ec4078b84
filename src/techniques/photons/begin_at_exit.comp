#version 460
// Photons at the exits from glass that a technique found. Neighbouring texels give the spacing of photons.
#extension GL_GOOGLE_include_directive : require
#define PELLUCID_MAKES_LISTS_ONLY
#include "techniques/visibility_layers/visibility_bindings.glsl"
#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/microfacets.glsl"
#include "techniques/visibility_layers/photon_paths.glsl"
#include "light/photon_windows.glsl"
#include "techniques/photons/photon_exits.glsl"
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

// The larger of the distances to two neighbours, and its growth along the path.
vec2 spacing_of(PhotonExit own, ivec2 texel, uvec2 within) {
    vec2 spacing = vec2(own.spacing, 0.0);
    float widest = 0.0;
    for (int k = 0; k < 2; ++k) {
        ivec2 step_ = ivec2(k, 1 - k) * (within[1 - k] + 1u < window_side ? 1 : -1);
        PhotonExit beside = exits[uint(texel.y + step_.y) * frame.width + uint(texel.x + step_.x)];
        vec3 apart = beside.position - own.position;
        apart -= dot(apart, own.direction) * own.direction;
        float distance_ = length(apart);
        if (beside.events == 0u || distance_ <= widest || distance_ > 8.0 * own.spacing) continue;
        widest = distance_;
        spacing = vec2(distance_, dot(beside.direction - own.direction, apart) / distance_);
    }
    return spacing;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    uint number = uint(texel.y) * frame.width + uint(texel.x), window;
    uvec2 within;
    waiting[number] = uvec2(0u);
    if (!window_of(texel, window, within)) return;
    PhotonExit own = exits[number];
    if (own.events == 0u) return;
    PathState state;
    state.path = Path(own.position, normalize(own.direction), own.flux, 0.0, own.events, 0u, kStatusOk, false);
    set_photon_spacing(state.path, spacing_of(own, texel, within));
    clear_media(state.media);
    state.standing = PELLUCID_NO_TRIANGLE;
    state.mark = 0u;
    state.pixel = number;
    save_path(state);
    append_next(texel);
}
