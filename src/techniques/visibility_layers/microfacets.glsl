#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_MICROFACETS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_MICROFACETS_GLSL

// Random decisions of a path, and the facets of rough glass: Heitz, "Sampling the GGX distribution of visible
// normals", JCGT 2018. Needs: frame, optics/interface.glsl.
#include "gpu/hash.glsl"
#include "gpu/tangent_frame.glsl"

uint sample_seed(ivec2 texel) { return hash(uvec3(texel + first_pixel(), 1u)).x; }

// Random numbers in [0, 1). Every event of every sample has its own, so decisions along a path are independent.
vec2 random_numbers(uint seed, uint event) {
    return vec2(hash(uvec3(seed, event, 2u * frame.sample_index)).xy >> 8u) / 16777216.0;
}
// Random numbers in [0, 1), well distributed over the indices, or samples, of a seed and event (a Kronecker sequence;
// powers of 1/1.16730398 by Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
vec2 spread_numbers(uint seed, uint event, uint number) {
    uvec2 bits = hash(uvec3(seed, event, 0x51f15e5du)).xy + uvec2(number) * uvec2(3679390609u, 3152041523u);
    return vec2(bits >> 8u) / 16777216.0;
}
vec2 spread_numbers(uint seed, uint event) { return spread_numbers(seed, event, frame.sample_index); }
float random_number(uint seed, uint event) {
    return float(hash(uvec3(seed, event, 2u * frame.sample_index + 1u)).z >> 8u) / 16777216.0;
}

// State of light between the facets of a rough boundary (Heitz, Hanika, d'Eon & Dachsbacher, "Multiple-scattering
// microfacet BSDFs with the Smith model", 2016). Twin of Ray in src/reference/rough_interface.h.
struct Facets {
    mat3 world_from_surface;  // z: the macroscopic normal on the path's incident side
    float alpha;
    float level;       // share of the surface that lies lower, 0..1, seen from the light's current side
    uint seed, event;  // seed and event of the path; `draws`: random numbers taken so far
    uint draws;
};
const int kMostFacets = 64;
const float kLowestLevel = 1e-7;  // about one rounding unit of 1

float facet_alpha(float roughness) { return max(roughness * roughness, 1e-4); }

float next_random(inout Facets facets) {
    ++facets.draws;
    return float(hash(uvec3(facets.seed ^ facets.draws * 0x9e3779b9u, facets.event, 2u * frame.sample_index)).z >> 8u) / 16777216.0;
}

// Samples a facet normal visible along w, whose z may have either sign, in the surface's frame.
vec3 visible_normal(vec3 w, float alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * w.xy, w.z));
    float squared = dot(stretched.xy, stretched.xy);
    vec3 t1 = squared > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(squared) : vec3(1.0, 0.0, 0.0);
    vec3 t2 = cross(stretched, t1);
    float radius = sqrt(u.x), angle = 6.283185307 * u.y, share = 0.5 * (1.0 + stretched.z);
    float x = radius * cos(angle), y = radius * sin(angle);
    y = (1.0 - share) * sqrt(max(1.0 - x * x, 0.0)) + share * y;
    vec3 m = x * t1 + y * t2 + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    return normalize(vec3(alpha * m.xy, max(m.z, 1e-6)));
}

// Smith's auxiliary function for GGX.
float smith_lambda(vec3 w, float alpha) {
    float cos2 = max(w.z * w.z, 1e-20);
    float t = alpha * alpha * max(1.0 - cos2, 0.0) / cos2;
    return 0.5 * t / (sqrt(1.0 + t) + 1.0);  // (sqrt(1 + t) - 1) / 2 without cancellation
}

// Reflection by one facet of a mirror.
struct FacetReflection {
    vec3 direction;  // unit, away from the surface
    float cosine;    // cosine to the facet's normal
    float visible;   // share that no other facet blocks; 0: the facet reflects into the surface
};

// Samples a facet visible from `towards`, unit and away from the surface. alpha 0: the surface is flat.
FacetReflection reflect_by_facet(vec3 normal, vec3 towards, float alpha, vec2 u) {
    mat3 world_from_surface = tangent_frame(normal);
    vec3 wo = towards * world_from_surface;
    wo = normalize(vec3(wo.xy, max(wo.z, 1e-4)));
    vec3 m = alpha > 0.0 ? visible_normal(wo, alpha, u) : vec3(0.0, 0.0, 1.0), wi = reflect(-wo, m);
    float hidden_o = smith_lambda(wo, alpha), hidden_i = smith_lambda(wi, alpha);
    return FacetReflection(normalize(world_from_surface * wi), dot(wo, m),
                           wi.z > 0.0 ? (1.0 + hidden_o) / (1.0 + hidden_o + hidden_i) : 0.0);
}

// Moves light along `way` to the next facet. Returns false if it leaves the surface.
bool reaches_facet(vec3 way, inout Facets facets) {
    float clear = 1.0 - next_random(facets);
    float lambda = smith_lambda(way, facets.alpha);
    if (way.z > 0.0) {
        if (clear <= pow(facets.level, lambda)) return false;
        facets.level *= pow(clear, -1.0 / lambda);
    } else {
        facets.level *= pow(clear, 1.0 / (1.0 + lambda));
    }
    facets.level = clamp(facets.level, kLowestLevel, 1.0);
    return true;
}

// Finds the first facet that a path hits, and its normal in world space. Returns false if the path comes from below
// the surface, which an interpolated normal may cause.
bool first_facet(vec3 normal, Path path, uint seed, float roughness, out Facets facets, out vec3 facet_normal) {
    facets = Facets(tangent_frame(normal), facet_alpha(roughness), 1.0, seed, path.events, 0u);
    vec3 way = path.direction * facets.world_from_surface;
    facet_normal = normal;
    if (way.z >= 0.0) return false;
    reaches_facet(way, facets);
    facet_normal = normalize(facets.world_from_surface * visible_normal(-way, facets.alpha, random_numbers(seed, path.events)));
    return true;
}

// Reflects or refracts light at a facet visible to it.
void scatter_at_facet(inout vec3 way, inout float eta, inout Facets facets, inout bool beyond) {
    vec2 u = vec2(next_random(facets), next_random(facets));
    vec3 m = visible_normal(-way, facets.alpha, u), refracted;
    if (next_random(facets) < fresnel_dielectric(-dot(way, m), eta)) {
        way = reflect_direction(way, m);
        return;
    }
    refract_direction(way, m, eta, refracted);
    way = vec3(refracted.xy, -refracted.z);
    facets.level = max(1.0 - facets.level, kLowestLevel);
    eta = 1.0 / eta;
    beyond = !beyond;
}

// Direction in which light leaves the surface, after a facet has sent it along `direction`. `beyond`: it is on the
// other side of the surface. eta = n_incident / n_transmitted on the path's incident side.
vec3 leave_facets(vec3 direction, float eta, Facets facets, inout bool beyond) {
    vec3 way = direction * facets.world_from_surface;
    // Beyond the surface the frame is flipped, so that z always points away from the surface.
    if (beyond) {
        way.z = -way.z;
        facets.level = max(1.0 - facets.level, kLowestLevel);
        eta = 1.0 / eta;
    }
    for (int n = 0; n < kMostFacets && reaches_facet(way, facets); ++n)
        scatter_at_facet(way, eta, facets, beyond);
    way.z = abs(way.z);  // a walk that reached the bound may point at the surface
    return normalize(facets.world_from_surface * vec3(way.xy, beyond ? -way.z : way.z));
}

#endif
