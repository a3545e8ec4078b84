#version 460
// Colours patches of wavefronts by their irradiance.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "gpu/fragment_depth.glsl"
#include "volume/front_color.glsl"

layout(set = 0, binding = 2, r32f) readonly uniform image2DArray opaque_depth;
layout(push_constant) uniform Push {
    uint drawn_object;  // set by Recorder::draw
    float exposure;
};

layout(location = 0) in vec3 world_position;
layout(location = 1) flat in vec3 irradiance;
layout(location = 0) out vec4 radiance;

void main() {
    // Discard faint light, such as reflections, because it would hide everything else.
    if (luminance(exposure * irradiance) < kFaintest) discard;
    if (eye_depth() > imageLoad(opaque_depth, ivec3(gl_FragCoord.xy, 0)).r) discard;
    // Shade the patch by its slope, so that its shape is visible.
    vec3 normal = normalize(cross(dFdx(world_position), dFdy(world_position)));
    vec3 way = normalize(mat3(frame.world_from_view) * camera_ray(gl_FragCoord.xy).direction);
    radiance = vec4(front_color(exposure * irradiance) * (0.4 + 0.6 * abs(dot(normal, way))), 1.0);
}
