#version 460
// Exits from glass of one window's light, found by a technique that was run from the light's view.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(set = 0, binding = 4, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(set = 0, binding = 5, rgba32f) readonly uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) readonly uniform image2DArray exit_position;
layout(set = 0, binding = 7, rgba32f) readonly uniform image2DArray transmittance;
layout(set = 0, binding = 8, r32ui) readonly uniform uimage2DArray path_events;
#include "layers/layers.glsl"
#include "layers/objects.glsl"
#include "light/photon_windows.glsl"
#include "techniques/photons/photon_exits.glsl"
#include "techniques/photons/sent_light.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { uint window; uint row; };  // `row`: texels in a row of all windows

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= int(frame.width) || texel.y >= int(frame.height)) return;
    ivec3 at = ivec3(texel, 0);
    uvec2 first = uvec2(window % window_columns, window / window_columns) * window_side;
    uint number = (first.y + uint(texel.y)) * row + first.x + uint(texel.x);
    uint events = imageLoad(path_events, at).r, triangle = imageLoad(layer_triangle, at).r;
    bool found = (events & 0xfffu) > 0u && ((events >> 24) & 0xfu) == 0u && triangle != PELLUCID_NO_TRIANGLE;
    exits[number] = PhotonExit(vec3(0.0), 0u, vec3(0.0), 0.0, vec3(0.0), 0.0);
    if (!found) return;
    SentLight sent = sent_light(windows[window], vec2(texel) + 0.5, vec2(0.0));
    // Apply the base colour once, at the exit.
    MaterialRecord material = materials[objects[find_object(triangle_index(triangle))].material];
    vec3 flux = sent.flux * imageLoad(transmittance, at).rgb * material.base_color.rgb * material.transmission;
    exits[number] = PhotonExit(imageLoad(exit_position, at).xyz, events & 0xfffu, imageLoad(exit_direction, at).xyz,
                               max(sent.spacing.x, sent.spacing.y * windows[window].target_depth), flux, 0.0);
}
