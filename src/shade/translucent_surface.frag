#version 460
// What light of lights meets at the nearest opaque surface where that is translucent: which surface it is, and the
// share of the light that it scatters on the viewer's side and through to the other.
#extension GL_GOOGLE_include_directive : require
#include "shade/surface_fragment.glsl"
#include "gpu/coat.glsl"
#include "gpu/coverage.glsl"
#include "gpu/octahedral.glsl"

#include "shade/exact_depth.glsl"

layout(set = 0, binding = 5, r32f) readonly uniform image2DArray opaque_depth;

layout(location = 0) out vec4 out_reflected;
layout(location = 1) out vec4 out_transmitted;
layout(location = 2) out uint out_triangle;
layout(location = 3) out uint out_normal;

void main() {
    MaterialRecord material = materials[material_index];
    vec4 base = base_color(material);
    bool behind;
    float depth = exact_depth(find_object(triangle), behind), nearest = imageLoad(opaque_depth, ivec3(gl_FragCoord.xy, 0)).r;
    if (depth > nearest + kDepthRounding * nearest) discard;
    if (alpha_margin(material, base.a, ivec2(gl_FragCoord.xy) + first_pixel(), triangle, 0u) < 0.0) discard;
    vec2 factors = sample_texture(material.metallic_roughness_texture, texcoords.xy, texcoords.zw).bg;
    vec3 view_direction = world_view_direction(), normal = facing_normal(view_direction);
    // Both come out through the coat, as the environment's light does (opaque_surface.glsl).
    float coat = coat_reflectance(material.ior, clamp(-dot(normal, view_direction), 1e-4, 1.0));
    float diffuse = (1.0 - material.metallic * factors.x) * (1.0 - coat);
    out_reflected = vec4(diffuse * base.rgb, 1.0);
    out_transmitted = vec4(diffuse * material.diffuse_transmission.rgb, 1.0);
    out_triangle = triangle;
    out_normal = pack_direction(normal);
    gl_FragDepth = eye_depth() * frame.depth_scale;
}
