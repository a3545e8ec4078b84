#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL

// What a path does at a surface. Needs: path_state.glsl, objects, materials, slots, map_triangles, map_normals
// (surface_map.glsl), threshold, most_branches, branch_capacity.
#include "gpu/object_traits.glsl"
#include "techniques/visibility_layers/filling_body.glsl"
#include "techniques/visibility_layers/microfacets.glsl"

// Of the surfaces' textures.
layout(std430, set = 0, binding = 40) readonly buffer Indices { uint indices[]; };
layout(std430, set = 0, binding = 41) readonly buffer Appearance { float appearance[]; };
layout(std430, set = 0, binding = 42) readonly buffer Textures { TextureRecord textures[]; };
layout(set = 0, binding = 43) uniform texture2DArray texture_pages;
#include "gpu/appearance.glsl"
#include "gpu/texture.glsl"

// A point of a triangle, in the world.
struct Surface {
    vec3 position;
    vec3 normal;      // unit, interpolated, outward
    vec3 geometric;   // of the triangle itself, outward, any length
    uint material;
    uint corner;      // first of the triangle's three, in `indices`
    vec3 weights;     // of the three corners
};

vec3 map_vector(utextureBuffer vectors, int number) { return uintBitsToFloat(texelFetch(vectors, number)).xyz; }

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
    vec3 normal = weights.x * map_vector(map_normals, at) + weights.y * map_vector(map_normals, at + 1) +
                  weights.z * map_vector(map_normals, at + 2);
    vec3 geometric = cross(edge_b, edge_c);
    if (kMapPerMesh) {
        normal = mat3(o.world_from_object_normal) * normal;
        geometric *= o.mirrored != 0u ? -1.0 : 1.0;
    }
    return Surface(a + weights.y * edge_b + weights.z * edge_c,
                   normalize(dot(normal, normal) > 1e-30 ? normal : geometric), geometric, o.material,
                   o.first_corner + 3u * (triangle - o.first_triangle), weights);
}

// Texture coordinates, both sets.
vec4 texcoords_at(Surface surface) {
    vec4 texcoords = vec4(0.0);
    for (uint k = 0u; k < 3u; ++k) texcoords += surface.weights[k] * vertex_texcoords(indices[surface.corner + k]);
    return texcoords;
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

bool refracts_apart(vec3 iors) { return kDispersive && (iors.r != iors.g || iors.b != iors.g); }

// Whether a path that carries so much may branch once more.
bool may_branch(uint i, vec3 weight) {
    return waiting[i].y < most_branches && max(weight.r, max(weight.g, weight.b)) > threshold;
}

// What the path is inside of on this side and on the other side of the boundary at hand.
uint media_here[kMediumWords], media_there[kMediumWords];

// After the direction has changed at a boundary: the interpolated normal can send a path to the other side of the
// triangle than it means to. It is where it goes.
void settle(vec3 direction, Surface surface, bool leaving) {
    bool through = (dot(direction, surface.geometric) > 0.0) == leaving;
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = through ? media_there[w] : media_here[w];
}

void branch_off(uint i, Path path, vec3 direction, vec3 weight, uint own_mark, Surface surface, bool leaving) {
    uint marked = mark;
    mark = own_mark;
    path.direction = direction;
    path.transmittance = weight;
    settle(direction, surface, leaving);
    push_branch(i, path, branch_capacity);
    mark = marked;
}

// Meets the boundary between two media: refracts, or reflects totally. What is reflected besides branches off; where
// it carries too little for that, its light goes on with what is refracted, so that none is lost.
void meet_boundary(uint i, inout Path path, Surface surface, bool leaving, vec3 n_i, vec3 n_t, bool first) {
    vec3 n = leaving ? -surface.normal : surface.normal;
    uint channel = mark & kChannelMask;
    uint c = channel == 0u ? 1u : channel - 1u;  // the direction is green's, unless the path has another channel
    float eta = n_i[c] / n_t[c];
    bool by_facets = kRough && (kStochastic || kTree);  // of rough glass, one way between them per sample
    Facets facets;
    float roughness = kRough ? surface_roughness(surface) : 0.0;
    bool rough = by_facets && roughness > 0.0 && first_facet(n, path, roughness, facets, n);
    float cos_theta_i = -dot(path.direction, n);
    path.side_conflict = path.side_conflict || cos_theta_i < 0.0;
    ++path.events;
    vec3 incident = path.direction, carried = path.transmittance, refracted;
    bool total = !refract_direction(incident, n, eta, refracted);
    float reflectance = total ? 1.0 : fresnel_dielectric(cos_theta_i, eta);
    float alpha = by_facets ? 0.0 : roughness * roughness;
    float bending = 0.5 * (max(n_i[c], n_t[c]) / min(n_i[c], n_t[c]) - 1.0);  // of a facet's tilt, beside reflection
    if (total) ++path.reflections;
    path.direction = refracted;  // under total reflection that is the reflected direction
    vec3 tint = leaving || first ? vec3(1.0) : surface_tint(surface).rgb;

    if (kStochastic) {
        bool beyond = !total && random_number(path.events) >= reflectance;
        if (!total && !beyond) path.direction = reflect_direction(incident, n);
        if (rough) path.direction = leave_facets(path.direction, eta, facets, beyond);
        if (beyond) path.transmittance *= tint;
        else if (first) mark |= kOuterBranch;
    } else if (total) {
        bool beyond = false;
        if (rough) path.direction = leave_facets(path.direction, eta, facets, beyond);
        if (beyond) path.transmittance *= tint;
    } else {
        if (kTree) {
            bool apart = channel == 0u && refracts_apart(n_i) || refracts_apart(n_t) && channel == 0u;
            if (apart && may_branch(i, carried)) {
                for (uint other = 0u; other < 3u; other += 2u) {
                    vec3 way;
                    float other_eta = n_i[other] / n_t[other], cosine = cos_theta_i;
                    if (!refract_direction(incident, n, other_eta, way)) continue;  // the reflection below has it all
                    vec3 only = vec3(other == 0u, 0.0, other == 2u);
                    uint own = (mark & ~(kChannelMask | kMainPath)) | (other + 1u);
                    bool beyond = true;
                    if (rough) way = leave_facets(way, other_eta, facets, beyond);
                    if (!beyond && first) own |= kOuterBranch;
                    vec3 weight = carried * only * (1.0 - fresnel_dielectric(cosine, other_eta));
                    branch_off(i, path, way, weight * (beyond ? tint : vec3(1.0)), own, surface, leaving);
                }
                mark |= 2u;
            }
            vec3 reflected = carried * reflectance;
            if ((mark & kChannelMask) != channel) {  // red and blue reflect a little less and more
                reflected = carried * vec3(fresnel_dielectric(cos_theta_i, n_i.r / n_t.r), reflectance,
                                           fresnel_dielectric(cos_theta_i, n_i.b / n_t.b));
            }
            if (may_branch(i, reflected)) {
                vec3 way = reflect_direction(incident, n);
                bool beyond = false;
                if (rough) way = leave_facets(way, eta, facets, beyond);
                if (beyond) reflected *= tint;
                uint own = (mark & ~(kChannelMask | kMainPath)) | channel | (first && !beyond ? kOuterBranch : 0u);
                uint kept = mark;
                mark = own;
                widen(alpha);
                own = mark;
                mark = kept;
                branch_off(i, path, way, reflected, own, surface, leaving);
                path.transmittance *= 1.0 - reflectance;
            }
            if ((mark & kChannelMask) != channel) path.transmittance *= vec3(0.0, 1.0, 0.0);
        } else {
            path.transmittance *= 1.0 - reflectance;
        }
        bool beyond = true;
        if (rough) path.direction = leave_facets(path.direction, eta, facets, beyond);
        if (beyond) path.transmittance *= tint;
        else if (first) mark |= kOuterBranch;
    }
    if (alpha > 0.0) widen(total ? alpha : alpha * bending);
    settle(path.direction, surface, leaving);
}

const uint kNoSlot = 0xffffffffu;

// Takes the path to the other side of a shell. Of one that is not closed its normal alone says where the path is.
void step_across(uint traits, bool leaving) {
    if (!kCrossing || (traits & kCrossesItself) == 0u) {
        set_inside(slot_of(traits), leaving == ((traits & kCavity) != 0u));
        return;
    }
    // The shell's slots are the steps of its winding number, from the least: those are passed that lie below it.
    uint changed = kNoSlot, slot = slot_of(traits);
    for (bool more = true; more; ++slot) {
        uint medium = slots[slot].medium;
        bool passed = inside_slot(slot) != ((medium & kCavitySlot) != 0u);
        if (leaving ? passed : (!passed && changed == kNoSlot)) changed = slot;
        more = (medium & kSameShell) != 0u;
    }
    if (changed != kNoSlot) set_inside(changed, leaving == ((slots[changed].medium & kCavitySlot) != 0u));
}
void note_here() {
    for (uint w = 0u; w < kMediumWords; ++w) media_here[w] = media[w];
}
void note_there() {
    for (uint w = 0u; w < kMediumWords; ++w) media_there[w] = media[w];
}
// Of an open surface: what its normal says.
void correct_side(uint traits, bool leaving) {
    if ((traits & kClosed) == 0u) set_inside(slot_of(traits), leaving);
}

#endif
