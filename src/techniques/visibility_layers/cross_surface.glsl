#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_SURFACE_GLSL

// What a path does at a surface. Needs: path_state.glsl, objects, materials, slots, map_triangles, map_normals
// (surface_map.glsl), threshold, most_branches, branch_capacity.
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
    float curvature;  // 1/m, mean, of the interpolated normals; above 0: bulges outward. Photons alone ask for it
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
    return Surface(a + weights.y * edge_b + weights.z * edge_c,
                   normalize(dot(normal, normal) > 1e-30 ? normal : geometric), geometric, o.material,
                   o.first_corner + 3u * (triangle - o.first_triangle), weights, curvature);
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
bool may_branch(uint pixel, vec3 weight) {
    return waiting[pixel].y < most_branches && max(weight.r, max(weight.g, weight.b)) > threshold;
}

// The boundary of two media at which a path stands.
struct Crossing {
    Surface surface;
    bool leaving;       // the shell that is met, along its outward normal
    bool first;         // by a view ray, from the open
    Media here, there;  // what the path is inside of on its side and on the other
    vec3 n_i, n_t;      // indices of refraction of both, per channel
};

// After the direction has changed at a boundary: the interpolated normal can send a path to the other side of the
// triangle than it means to. It is where it goes.
void settle(inout PathState state, Crossing crossing) {
    bool through = (dot(state.path.direction, crossing.surface.geometric) > 0.0) == crossing.leaving;
    for (uint w = 0u; w < kMediumWords; ++w)
        state.media.words[w] = through ? crossing.there.words[w] : crossing.here.words[w];
}

void branch_off(PathState state, Crossing crossing, vec3 direction, vec3 weight, uint mark) {
    state.path.direction = direction;
    state.path.transmittance = weight;
    state.mark = mark;
    settle(state, crossing);
    push_branch(state, branch_capacity, true);
}

// How light meets a boundary: what all ways from there have in common.
struct Meeting {
    vec3 normal;        // unit, on the path's side; of rough glass that of a facet
    vec3 incident;      // the path's direction
    vec3 carried;       // and transmittance
    uint channel;       // and channel, kChannelMask; its direction is green's, unless it has another
    float cosine;
    float eta;
    bool total;         // reflection
    float reflectance;
    vec3 onward;        // direction of what is refracted, or totally reflected
    vec3 tint;          // what the surface leaves of what passes
    bool rough;         // the path goes from facet to facet
    Facets facets;
    float alpha;        // of the lobe that stands for facets elsewhere
    float bending;      // of a facet's tilt, beside reflection
};

// Of rough glass, each sample meets one facet.
Meeting meet(inout PathState state, Crossing crossing) {
    Meeting m;
    m.normal = crossing.leaving ? -crossing.surface.normal : crossing.surface.normal;
    m.channel = state.mark & kChannelMask;
    uint color = m.channel == 0u ? 1u : m.channel - 1u;
    float n_i = crossing.n_i[color], n_t = crossing.n_t[color];
    m.eta = n_i / n_t;
    m.bending = 0.5 * (max(n_i, n_t) / min(n_i, n_t) - 1.0);
    float roughness = kRough ? surface_roughness(crossing.surface) : 0.0;
    state.mark = after_surface(state.mark, roughness > 0.0);
    bool by_facets = kRough && (kStochastic || kTree);
    m.rough = by_facets && roughness > 0.0 &&
              first_facet(m.normal, state.path, state.seed, roughness, m.facets, m.normal);
    m.alpha = by_facets ? 0.0 : roughness * roughness;
    m.incident = state.path.direction;
    m.carried = state.path.transmittance;
    m.cosine = -dot(m.incident, m.normal);
    m.total = !refract_direction(m.incident, m.normal, m.eta, m.onward);
    m.reflectance = m.total ? 1.0 : fresnel_dielectric(m.cosine, m.eta);
    // Base colour counts where a path from the eye enters the solid, so where light leaves it.
    bool tinted = kFromLight ? crossing.leaving : !(crossing.leaving || crossing.first);
    m.tint = tinted ? surface_tint(crossing.surface).rgb : vec3(1.0);
    state.path.side_conflict = state.path.side_conflict || m.cosine < 0.0;
    ++state.path.events;
    if (m.total) ++state.path.reflections;
    return m;
}

// Goes on in a direction; through facets, where the surface is rough.
void go_from(inout PathState state, Meeting m, vec3 direction, bool beyond, bool first) {
    state.path.direction = m.rough ? leave_facets(direction, m.eta, m.facets, beyond) : direction;
    if (beyond) state.path.transmittance *= m.tint;
    else if (first) state.mark |= kOuterBranch;
}

// Red and blue leave a dispersive path on ways of their own; it goes on as green.
void branch_colors(inout PathState state, Crossing crossing, Meeting m) {
    bool apart = m.channel == 0u && (refracts_apart(crossing.n_i) || refracts_apart(crossing.n_t));
    if (!apart || !may_branch(state.pixel, m.carried)) return;
    for (uint other = 0u; other < 3u; other += 2u) {
        vec3 way;
        float eta = crossing.n_i[other] / crossing.n_t[other];
        if (!refract_direction(m.incident, m.normal, eta, way)) continue;  // what is reflected has it all
        bool beyond = true;
        if (m.rough) way = leave_facets(way, eta, m.facets, beyond);
        uint mark = (state.mark & ~(kChannelMask | kMainPath)) | (other + 1u);
        if (!beyond && crossing.first) mark |= kOuterBranch;
        vec3 only = vec3(other == 0u, 0.0, other == 2u);
        vec3 weight = m.carried * only * (1.0 - fresnel_dielectric(m.cosine, eta)) * (beyond ? m.tint : vec3(1.0));
        branch_off(state, crossing, way, weight, mark);
    }
    state.mark |= 2u;
}

// What is reflected branches off; where it carries too little for that, its light goes on with what is refracted, so that
// none is lost.
void branch_reflection(inout PathState state, Crossing crossing, Meeting m) {
    bool parted = (state.mark & kChannelMask) != m.channel;  // red and blue reflect a little less and more
    vec3 reflectances = vec3(m.reflectance);
    if (parted) {
        reflectances.r = fresnel_dielectric(m.cosine, crossing.n_i.r / crossing.n_t.r);
        reflectances.b = fresnel_dielectric(m.cosine, crossing.n_i.b / crossing.n_t.b);
    }
    vec3 reflected = m.carried * reflectances;
    if (may_branch(state.pixel, reflected)) {
        vec3 way = reflect_direction(m.incident, m.normal);
        bool beyond = false;
        if (m.rough) way = leave_facets(way, m.eta, m.facets, beyond);
        if (beyond) reflected *= m.tint;
        uint mark = (state.mark & ~(kChannelMask | kMainPath)) | m.channel;
        if (crossing.first && !beyond) mark |= kOuterBranch;
        branch_off(state, crossing, way, reflected, widened(mark, m.alpha));
        state.path.transmittance *= 1.0 - m.reflectance;
    }
    if (parted) state.path.transmittance *= vec3(0.0, 1.0, 0.0);
}

// Takes a path past the boundary between two media, or back from it.
void cross_boundary(inout PathState state, Crossing crossing) {
    if (kFromLight && kDispersive) choose_channel(state, refracts_apart(crossing.n_i) || refracts_apart(crossing.n_t));
    Meeting m = meet(state, crossing);
    if (kStochastic) {
        float choice = kFromLight ? photon_choice(state) : random_number(state.seed, state.path.events);
        bool beyond = !m.total && choice >= m.reflectance;
        vec3 way = m.total || beyond ? m.onward : reflect_direction(m.incident, m.normal);
        go_from(state, m, way, beyond, crossing.first);
        if (kFromLight) {
            float bend = crossing.leaving ? -crossing.surface.curvature : crossing.surface.curvature;
            refract_spacing(state.path, m.cosine, m.eta, bend, beyond, beyond ? 1.0 - m.reflectance : m.reflectance, m.normal);
            state.path.transmittance *= adjoint_weight(m.incident, state.path.direction, crossing.surface.normal,
                                                       crossing.surface.geometric);
        }
    } else if (m.total) {
        go_from(state, m, m.onward, false, false);
    } else {
        if (kTree) {
            branch_colors(state, crossing, m);
            branch_reflection(state, crossing, m);
        } else {
            state.path.transmittance *= 1.0 - m.reflectance;
        }
        go_from(state, m, m.onward, true, crossing.first);
    }
    if (m.alpha > 0.0) state.mark = widened(state.mark, m.total ? m.alpha : m.alpha * m.bending);
    settle(state, crossing);
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
