#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL

// Surfaces that paths meet, and the media on their sides. Needs: path_state.glsl, objects, materials, slots, map_triangles, map_normals
// (surface_map.glsl), threshold, most_branches.
#include "gpu/object_traits.glsl"
#include "techniques/visibility_layers/filling_body.glsl"
#include "techniques/visibility_layers/microfacets.glsl"
#include "techniques/visibility_layers/photon_paths.glsl"

// Of the surfaces' textures.
#ifndef PELLUCID_GPU_VERTICES_GLSL
layout(std430, set = 0, binding = 40) readonly buffer Indices { uint indices[]; };
#endif
layout(std430, set = 0, binding = 41) readonly buffer Appearance { float appearance[]; };
layout(std430, set = 0, binding = 42) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 43) uniform texture2DArray texture_pages;
layout(std430, set = 0, binding = 66) readonly buffer Tangents { uint tangents[]; };
#include "gpu/appearance.glsl"
#include "gpu/texture.glsl"
#include "gpu/tangents.glsl"

// A point of a triangle, in the world.
struct Surface {
    vec3 position;
    vec3 normal;      // unit, interpolated, outward
    vec3 geometric;   // of the triangle itself, outward, any length
    uint material;
    uint corner;      // first of the triangle's three, in `indices`
    vec3 weights;     // of the three corners
    float curvature;  // 1/m, mean, of the interpolated normals; above 0: bulges outward. Photons alone ask for it
};

vec3 map_vector(utextureBuffer vectors, int number) { return uintBitsToFloat(texelFetch(vectors, number)).xyz; }

// Texture coordinates, both sets.
vec4 texcoords_at(Surface surface) {
    vec4 texcoords = vec4(0.0);
    for (uint k = 0u; k < 3u; ++k) texcoords += surface.weights[k] * vertex_texcoords(indices[surface.corner + k]);
    return texcoords;
}

// The normal with the material's texture, bent as little as the ray needs to be mirrored above the triangle.
vec3 textured_normal(Surface surface, ObjectRecord object, vec3 edge_b, vec3 edge_c, vec3 direction) {
    MaterialRecord material = materials[surface.material];
    if (material.normal_texture == PELLUCID_NO_TEXTURE) return surface.normal;
    uvec3 v = uvec3(indices[surface.corner], indices[surface.corner + 1u], indices[surface.corner + 2u]);
    TexturedPoint point = TexturedPoint(v, surface.weights, edge_b, edge_c, texcoords_at(surface));
    float side = dot(surface.geometric, direction) < 0.0 ? 1.0 : -1.0;
    return side * seen_normal(point, object, surface.normal, side, material.normal_texture, material.normal_scale, -direction);
}

Surface surface_at(uint triangle, uint object, vec3 origin, vec3 direction) {
    ObjectRecord o = objects[object];
    int at = 3 * int(kMapPerMesh ? triangle - o.first_triangle + o.first_corner / 3u : triangle);
    vec3 a = map_vector(map_triangles, at), edge_b = map_vector(map_triangles, at + 1),
         edge_c = map_vector(map_triangles, at + 2);
    if (kMapPerMesh) {
        a = (o.world_from_object * vec4(a, 1.0)).xyz;
        edge_b = mat3(o.world_from_object) * edge_b;
        edge_c = mat3(o.world_from_object) * edge_c;
    }
    vec3 weights = corner_weights(direction, a - origin, edge_b, edge_c);
    vec3 normal_a = map_vector(map_normals, at), normal_b = map_vector(map_normals, at + 1),
         normal_c = map_vector(map_normals, at + 2);
    vec3 normal = weights.x * normal_a + weights.y * normal_b + weights.z * normal_c;
    vec3 geometric = cross(edge_b, edge_c);
    float curvature = 0.0;
    if (kFromLight) {
        mat3 turn = kMapPerMesh ? mat3(o.world_from_object_normal) : mat3(1.0);
        curvature = mean_curvature(turn * normal_a, turn * normal_b, turn * normal_c, edge_b, edge_c);
    }
    if (kMapPerMesh) {
        normal = mat3(o.world_from_object_normal) * normal;
        geometric *= o.mirrored != 0u ? -1.0 : 1.0;
    }
    Surface surface = Surface(a + weights.y * edge_b + weights.z * edge_c,
                              normalize(dot(normal, normal) > 1e-30 ? normal : geometric), geometric, o.material,
                              o.first_corner + 3u * (triangle - o.first_triangle), weights, curvature);
    if (kTexturedGlass) surface.normal = textured_normal(surface, o, edge_b, edge_c, direction);
    return surface;
}

// What the surface leaves of light that passes it: base colour times transmission. w: its alpha, where that is coverage,
// otherwise 1.
vec4 surface_tint(Surface surface) {
    MaterialRecord material = materials[surface.material];
    vec4 base = material.base_color;
    float transmission = material.transmission;
    if (kTexturedGlass) {
        vec4 texcoords = texcoords_at(surface), color = vec4(0.0);
        for (uint k = 0u; k < 3u; ++k) color += surface.weights[k] * vertex_color_of(indices[surface.corner + k]);
        base *= color * sample_texture(material.base_color_texture, texcoords.xy, texcoords.zw);
        transmission *= sample_texture(material.transmission_texture, texcoords.xy, texcoords.zw).r;
    }
    return vec4(base.rgb * transmission, (material.flags & PELLUCID_MATERIAL_COVERAGE) != 0u ? base.a : 1.0);
}

float surface_roughness(Surface surface) {
    MaterialRecord material = materials[surface.material];
    if (!kTexturedGlass || material.roughness == 0.0) return material.roughness;
    vec4 texcoords = texcoords_at(surface);
    return material.roughness * sample_texture(material.metallic_roughness_texture, texcoords.xy, texcoords.zw).g;
}

// Whether a path that carries so much may branch once more.
bool may_branch(uint pixel, vec3 weight) {
    return waiting[pixel].y < most_branches && largest(weight) > threshold;
}

const uint kNoSlot = 0xffffffffu;

// Takes a path to the other side of a shell.
void step_across(inout Media media, uint traits, bool leaving) {
    if (!kCrossing || (traits & kCrossesItself) == 0u) {
        set_inside(media, slot_of(traits), leaving == ((traits & kCavity) != 0u));
        return;
    }
    // The shell's slots are the steps of its winding number, from the least: those are passed that lie below it.
    uint changed = kNoSlot, slot = slot_of(traits);
    for (bool more = true; more; ++slot) {
        uint medium = slots[slot].medium;
        bool passed = is_inside(media, slot) != ((medium & kCavitySlot) != 0u);
        if (leaving ? passed : (!passed && changed == kNoSlot)) changed = slot;
        more = (medium & kSameShell) != 0u;
    }
    if (changed != kNoSlot) set_inside(media, changed, leaving == ((slots[changed].medium & kCavitySlot) != 0u));
}

// Of an open surface its normal alone says where the path is.
void correct_side(inout Media media, uint traits, bool leaving) {
    if ((traits & kClosed) == 0u) set_inside(media, slot_of(traits), leaving);
}

#endif
