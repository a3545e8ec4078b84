#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_END_PATHS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_END_PATHS_GLSL

// Paths that have come to their end: what light comes from there; then the pixel's next branch, if one waits.
// Programs that define PELLUCID_LIT shine lights (lights_on_surfaces.glsl) on opaque surfaces, too.
#include "techniques/visibility_layers/visibility_bindings.glsl"

layout(constant_id = 6) const uint kEnvironmentKind = 0u;
layout(constant_id = 7) const bool kOpaqueObjects = false;  // there are some
#define PELLUCID_ENVIRONMENT_KIND kEnvironmentKind

layout(std430, set = 0, binding = 3) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 4) uniform texture2DArray texture_pages;
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2DArray exit_direction;
layout(set = 0, binding = 6, rgba32f) writeonly uniform image2DArray exit_position;
layout(set = 0, binding = 9, rgba32f) writeonly uniform image2DArray transmittance;
layout(set = 0, binding = 14, r32ui) writeonly uniform uimage2DArray path_events;
layout(set = 0, binding = 15) uniform texture2D environment_map;
layout(set = 0, binding = 16) uniform texture2D filtered_environment;
#include "gpu/object_traits.glsl"
layout(std430, set = 0, binding = 17) readonly buffer Appearance { float appearance[]; };
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)

#include "gpu/appearance.glsl"
#include "gpu/vertices.glsl"
#include "techniques/visibility_layers/path_state.glsl"
layout(std430, set = 0, binding = 44) readonly buffer Slots { SlotRecord slots[]; };
#include "techniques/visibility_layers/filling_body.glsl"
#include "techniques/visibility_layers/path_light.glsl"
#include "techniques/visibility_layers/microfacets.glsl"
#include "gpu/opaque_surface.glsl"
#ifdef PELLUCID_LIT
#include "techniques/ihrke_2007/lights_on_surfaces.glsl"
#endif

// Light by which a bounced path accounts for a direction: blurred, so that a small sun does not show as noise.
const float kBounceRoughness = 0.5;
vec3 bounce_light(vec3 direction) { return filtered_environment_radiance(direction, kBounceRoughness); }

struct OpaqueLight {
    vec3 radiance;  // as if the surface stood alone under the environment
    float alpha;    // less the cutoff: below 0 where there is a hole
    vec3 normal;    // unit, on the path's side
    vec3 diffuse;   // albedo
};

// Of the opaque surface that the path stands on.
OpaqueLight opaque_light(PathState state) {
    Path path = state.path;
    uint standing = state.standing, object = object_of(standing);
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (standing - o.first_triangle);
    uvec3 v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = (o.world_from_object * vec4(vertex_position(v.x), 1.0)).xyz;
    vec3 edge_b = (o.world_from_object * vec4(vertex_position(v.y), 1.0)).xyz - a;
    vec3 edge_c = (o.world_from_object * vec4(vertex_position(v.z), 1.0)).xyz - a;
    vec3 w = corner_weights(path.direction, a - path.position, edge_b, edge_c);
    vec3 normal = mat3(o.world_from_object_normal) *
                  (w.x * vertex_normal(v.x) + w.y * vertex_normal(v.y) + w.z * vertex_normal(v.z));
    if (!(dot(normal, normal) > 1e-30)) normal = cross(edge_b, edge_c);
    normal = normalize(normal);
    vec4 texcoords = vec4(0.0), color = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        texcoords += w[k] * vertex_texcoords(v[k]);
        color += w[k] * vertex_color_of(v[k]);
    }
    MaterialRecord material = materials[o.material];
    vec4 base = material.base_color * color * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw);
    vec3 light = opaque_material_radiance(material, base.rgb, texcoords.xy, texcoords.zw,
                                          faceforward(normal, path.direction, normal), -path.direction);
    // Paths carry radiance over n^2: what a surface emits into a medium, and what lamps in it throw, is divided by that.
    float ior = filling_iors(filling_body(state.media)).g;
    if (ior != 1.0 && (material.flags & PELLUCID_MATERIAL_UNLIT) == 0u)
        light -= (1.0 - 1.0 / (ior * ior)) * emitted_radiance(material, texcoords.xy, texcoords.zw);
    bool unlit = (material.flags & PELLUCID_MATERIAL_UNLIT) != 0u;
    float metallic = material.metallic *
                     sample_texture(material.metallic_roughness_texture, texcoords.xy, texcoords.zw).b;
    float root = (material.ior - 1.0) / (material.ior + 1.0);
    vec3 facing = faceforward(normal, path.direction, normal);
    vec3 diffuse = unlit ? vec3(0.0) : (1.0 - metallic) * (1.0 - root * root) * base.rgb;
#ifdef PELLUCID_LIT
    if (!unlit) light += diffuse / (3.14159265 * ior * ior) * irradiance_of_lights(path.position, facing);
#endif
    return OpaqueLight(light, base.a - material.alpha_cutoff, facing, diffuse);
}

// One direction of those from which the surface has been lit, to see what is there instead of the environment. What it
// then finds counts, less what was assumed: surfaces that stand alone stay as they are, without noise.
void bounce(ivec2 texel, PathState state, OpaqueLight light) {
    vec3 weight = state.path.transmittance * light.diffuse;
    uint branches_before = waiting[state.pixel].y;
    if (has_mark(state, kBounced) || branches_before >= most_branches || !(max(weight.r, max(weight.g, weight.b)) > threshold)) return;
    vec2 u = random_numbers(hash(uvec3(texel + first_pixel(), 77u + branches_before)).x, state.path.events);
    float radius = sqrt(u.x), angle = 6.283185307 * u.y;
    vec3 across = normalize(abs(light.normal.z) < 0.9 ? cross(light.normal, vec3(0.0, 0.0, 1.0))
                                                      : cross(light.normal, vec3(1.0, 0.0, 0.0)));
    vec3 way = radius * cos(angle) * across + radius * sin(angle) * cross(light.normal, across) +
                    sqrt(max(1.0 - u.x, 0.0)) * light.normal;
    uint mark = state.mark;
    state.path.direction = way;
    state.path.transmittance = weight;
    state.mark = (mark & ~(kMainPath | kMetOpaque)) | kBounced;
    if (push_branch(state, branch_capacity)) add_light(texel, mark, -weight * bounce_light(way));
}

// What the environment sends along a path.
vec3 environment_light(PathState state) {
    vec3 direction = state.path.direction;
    float spread = kRough ? spread_of(state.mark) : 0.0;
    if (has_mark(state, kBounced)) return state.path.transmittance * bounce_light(direction);
    if (spread > 0.0) return state.path.transmittance * filtered_environment_radiance(direction, sqrt(spread));
    return state.path.transmittance * environment_radiance(direction);
}

void store_result(ivec2 texel, PathState state) {
    ivec3 at = ivec3(texel, 0);
    Path path = state.path;
    float object = has_mark(state, kMetOpaque) ? float(object_of(state.standing)) : kEndsInEnvironment;
    imageStore(exit_direction, at, vec4(path.direction, path.length_inside));
    imageStore(exit_position, at, vec4(path.position, object));
    imageStore(transmittance, at, vec4(path.transmittance, 1.0));
    // A path that has crossed a volume without a surface has met something, too.
    if (kVolumes && has_mark(state, kCrossedVolume)) path.events = max(path.events, 1u);
    imageStore(path_events, at, uvec4(pack_events(path)));
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    PathState state;
    load_path(i, 0u, state);
    if (kOpaqueObjects && closing == 0u && has_mark(state, kMetOpaque)) {
        OpaqueLight light = opaque_light(state);
        if (light.alpha < 0.0) {  // a hole: the path goes on
            state.mark &= ~kMetOpaque;
            save_path(state);
            append_next(texel);
            return;
        }
        if (has_mark(state, kMainPath)) store_result(texel, state);
        add_light(texel, state.mark, state.path.transmittance * light.radiance);
        if (kTree) bounce(texel, state, light);
    } else {
        if (closing != 0u && has_mark(state, kMainPath)) state.path.status = kStatusEventLimit;
        if (has_mark(state, kMainPath)) store_result(texel, state);
        if (kTree || kStochastic || whole_picture != 0u) add_light(texel, state.mark, environment_light(state));
    }
    if (closing != 0u) {
        while (pop_branch(state)) add_light(texel, state.mark, environment_light(state));
    } else if (pop_branch(state)) {
        save_path(state);
        append_next(texel);
    }
}

#endif
