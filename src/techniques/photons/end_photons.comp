#version 460
// Photons that have come to an opaque surface: what glass or metal has bent on its way is stored; metal that mirrors sends
// them on.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "techniques/visibility_layers/visibility_bindings.glsl"

layout(std430, set = 0, binding = 3) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 4) uniform texture2DArray texture_pages;
layout(std430, set = 0, binding = 17) readonly buffer Appearance { float appearance[]; };
PELLUCID_APPENDED_LIST(NextList, 18, next_groups, next_length, next_pixels, append_next)
#include "gpu/appearance.glsl"
#include "gpu/coverage.glsl"
#include "gpu/octahedral.glsl"
#include "gpu/texture.glsl"
#include "gpu/vertices.glsl"
#include "light/photon_windows.glsl"
#include "light/photons.glsl"
#include "techniques/visibility_layers/path_state.glsl"
#include "techniques/visibility_layers/microfacets.glsl"
#include "techniques/visibility_layers/photon_paths.glsl"
layout(std430, set = 0, binding = 53) buffer Photons { uint photon_count, photon_reserved[3]; Photon photons[]; };

#include "light/photon_mirrors.glsl"

// The opaque surface that a photon stands on.
struct Landing {
    uint object;
    vec3 normal;     // unit, interpolated, on the photon's side
    vec3 geometric;  // unit, of the triangle, likewise
    vec4 base;
};

Landing landing_of(PathState state) {
    uint object = object_of(state.standing);
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (state.standing - o.first_triangle);
    uvec3 v = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = (o.world_from_object * vec4(vertex_position(v.x), 1.0)).xyz;
    vec3 edge_b = (o.world_from_object * vec4(vertex_position(v.y), 1.0)).xyz - a;
    vec3 edge_c = (o.world_from_object * vec4(vertex_position(v.z), 1.0)).xyz - a;
    vec3 direction = state.path.direction, w = corner_weights(direction, a - state.path.position, edge_b, edge_c);
    vec3 geometric = normalize(cross(edge_b, edge_c));
    vec3 normal = mat3(o.world_from_object_normal) *
                  (w.x * vertex_normal(v.x) + w.y * vertex_normal(v.y) + w.z * vertex_normal(v.z));
    normal = dot(normal, normal) > 1e-30 ? normalize(normal) : geometric;
    vec4 texcoords = vec4(0.0), color = vec4(0.0);
    for (int k = 0; k < 3; ++k) {
        texcoords += w[k] * vertex_texcoords(v[k]);
        color += w[k] * vertex_color_of(v[k]);
    }
    MaterialRecord material = materials[o.material];
    vec4 base = material.base_color * color * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw);
    return Landing(object, faceforward(normal, direction, normal), faceforward(geometric, direction, geometric), base);
}

// Sends a photon on from metal, by a facet that it can see. False: the facet sends it below the surface.
bool reflect_photon(inout PathState state, Landing landing, MaterialRecord material) {
    vec3 n = landing.normal, incident = state.path.direction;
    FacetReflection reflected = reflect_by_facet(n, -incident, max(material.roughness * material.roughness, 1e-4),
                                                 random_numbers(state.seed, state.path.events));
    vec3 direction = reflected.direction;
    if (reflected.visible == 0.0 || dot(direction, landing.geometric) <= 0.0) return false;
    float grazing = pow(clamp(1.0 - reflected.cosine, 0.0, 1.0), 5.0);
    state.path.transmittance *= mix(landing.base.rgb, vec3(1.0), grazing) * reflected.visible *
                                adjoint_weight(incident, direction, n, landing.geometric);
    state.path.direction = direction;
    ++state.path.events;
    state.mark &= ~kUnbent;
    return true;
}

// `straight`: nothing has bent its path. `flag`: 0 or kDiffusePhoton.
void store_photon(ivec2 texel, PathState state, uint object, vec3 normal, bool straight, uint flag) {
    uint number = atomicAdd(photon_count, 1u);
    if (number >= uint(photons.length())) return;  // counted: the frame is drawn again
    float cosine = max(abs(dot(normal, state.path.direction)), 0.05);
    float radius = kernel_width * abs(photon_spacing(state.path).x) * inversesqrt(cosine);
    radius = clamp(radius, least_radius, least_radius * float(1 << (kPhotonLevels - 1)));
    uint level = straight ? kStraightPhoton : photon_level(least_radius, radius);
    photons[number] = Photon(state.path.position, radius, state.path.transmittance, pack_direction(normal), level, object,
                             list_word(texel), (pack_direction(state.path.direction) & ~kDiffusePhoton) | flag);
}

void end_on_surface(ivec2 texel, PathState state, Landing landing) {
    uint window;
    uvec2 within;
    window_of(texel, window, within);
    PunctualLight light = windows[window].light;
    float relative = distance(light.position, state.path.position) * light.inverse_range, squared = relative * relative;
    if (light.kind != kDirectionalLight) state.path.transmittance *= clamp(1.0 - squared * squared, 0.0, 1.0);
    bool straight = state.path.events == 0u;
    uint flag = windows[window].source == kFromLights ? 0u : kDiffusePhoton;
    if (!straight || lists_straight != 0u) store_photon(texel, state, landing.object, landing.geometric, straight, flag);
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    uint i = uint(texel.y) * frame.width + uint(texel.x);
    PathState state;
    load_path(i, sample_seed(texel), state);
    bool lands = closing == 0u && has_mark(state, kMetOpaque);
    if (!lands) {
        if (lists_straight != 0u) store_photon(texel, state, PELLUCID_NO_TRIANGLE, state.path.direction, true, 0u);
        return;
    }
    Landing landing = landing_of(state);
    MaterialRecord material = materials[objects[landing.object].material];
    bool goes_on = alpha_margin(material, landing.base.a, texel, state.standing, 1u + state.path.events) < 0.0;  // a hole
    if (!goes_on && reflects_photons(material)) {
        bool reflects = random_number(state.seed ^ 0x68bc21ebu, state.path.events) < material.metallic;
        if (reflects && (state.path.events >= max_events || !reflect_photon(state, landing, material))) return;
        goes_on = reflects;
        if (!reflects) state.path.transmittance /= 1.0 - material.metallic;
        choose_spacing(state.path, reflects ? material.metallic : 1.0 - material.metallic);
    }
    if (!goes_on) {
        end_on_surface(texel, state, landing);
        return;
    }
    state.mark &= ~kMetOpaque;
    save_path(state);
    append_next(texel);
}
