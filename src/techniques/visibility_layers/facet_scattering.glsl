#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FACET_SCATTERING_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_FACET_SCATTERING_GLSL

// Light that a rough boundary scatters from one direction to another: Heitz et al. 2016. Twin of
// src/reference/rough_interface.cpp, which explains the formulas. Needs: microfacets.glsl, optics/interface.glsl.
//
// All directions are in the surface's frame. wo and wi point away from the surface, wo.z > 0. `way` is a direction of
// travel, in a frame whose z axis is the normal on the light's side. eta = n_here / n_there, seen from that side.

vec3 to_other_side(vec3 w) { return vec3(w.xy, -w.z); }

// GGX: density of normals m, m.z > 0, per solid angle and projected area.
float facet_density(vec3 m, float alpha) {
    float a2 = alpha * alpha, d = dot(m.xy, m.xy) + a2 * m.z * m.z;
    return a2 / (3.14159265 * d * d);
}

// Projected area along w of the facets that face w, per macroscopic area. w may point below the surface.
float projected_area(vec3 w, float alpha) {
    float cos2 = w.z * w.z, slope2 = alpha * alpha * max(1.0 - cos2, 0.0), slanted = sqrt(cos2 + slope2);
    return w.z < 0.0 ? 0.5 * slope2 / (slanted - w.z) : 0.5 * (slanted + w.z);  // no cancellation below the horizon
}

// Density with which the next facet reflects light travelling along `way` to w.
float reflected_density(vec3 way, vec3 w, float eta, float alpha) {
    vec3 sum = w - way;
    if (!(sum.z > 0.0)) return 0.0;
    vec3 m = normalize(sum);
    return fresnel_dielectric(-dot(way, m), eta) * facet_density(m, alpha) / (4.0 * projected_area(-way, alpha));
}

// Density with which the next facet refracts light travelling along `way` to w: Walter et al. 2007, equations 16 and
// 17.
float refracted_density(vec3 way, vec3 w, float eta, float alpha) {
    vec3 sum = w - eta * way;
    float length_ = length(sum);
    if (!(length_ > 0.0)) return 0.0;
    vec3 m = sum.z < 0.0 ? -sum / length_ : sum / length_;
    float cos_here = -dot(way, m), cos_there = dot(w, m);
    if (cos_here <= 0.0 || cos_there >= 0.0) return 0.0;
    float stretch = eta * cos_here + cos_there;
    return (1.0 - fresnel_dielectric(cos_here, eta)) * facet_density(m, alpha) * cos_here * -cos_there /
           (projected_area(-way, alpha) * stretch * stretch);
}

// Density with which the next facet, at the level of `facets`, sends light out of the surface to w.
float leaving_density(vec3 way, vec3 w, float eta, Facets facets) {
    float lambda = smith_lambda(w, facets.alpha);
    if (w.z > 0.0) return reflected_density(way, w, eta, facets.alpha) * pow(facets.level, lambda);
    return refracted_density(way, w, eta, facets.alpha) * pow(1.0 - facets.level, lambda);
}

// Estimates the share of random walks from `from` whose last facet sends the light to `to`. Walks over two or more
// facets can also start at the other end; the balance heuristic combines both. `reversal`: density from -> to over
// density to -> from. `first`: include walks over one facet.
float walk_towards(vec3 from, vec3 to, float eta, float reversal, bool first, inout Facets facets) {
    bool beyond = from.z < 0.0;
    vec3 way = beyond ? to_other_side(-from) : -from;
    if (beyond) eta = 1.0 / eta;
    facets.level = 1.0;
    float sum = 0.0, back = 0.0;
    for (int n = 0; n < kMostFacets && reaches_facet(way, facets); ++n) {
        float there = leaving_density(way, beyond ? to_other_side(to) : to, eta, facets);
        if (n == 0 && first) sum += there;
        else if (n > 0 && there > 0.0) sum += there * back / (there + back);
        scatter_at_facet(way, eta, facets, beyond);
        if (n == 0) back = reversal * leaving_density(-way, beyond ? to_other_side(from) : from, eta, facets);
    }
    return sum;
}

// BSDF times |cos theta_i| for radiance over n^2, per steradian: an unbiased estimate.
float facet_scattering(vec3 wo, vec3 wi, float eta, inout Facets facets) {
    float n = wi.z > 0.0 ? 1.0 : 1.0 / eta;
    float reversal = n * n * abs(wi.z) / wo.z;
    float forward = walk_towards(wo, wi, eta, reversal, true, facets);
    return forward + reversal * walk_towards(wi, wo, eta, 1.0 / reversal, false, facets);
}

// Substitute for the density of sampled directions in the power heuristic, which allows any positive function.
float stand_in_density(vec3 wo, vec3 wi, float eta, float alpha) {
    float single = wi.z > 0.0 ? reflected_density(-wo, wi, eta, alpha) : refracted_density(-wo, wi, eta, alpha);
    float hidden_o = 1.0 + smith_lambda(wo, alpha), hidden_i = smith_lambda(wi, alpha);
    return single * hidden_o / (hidden_o + hidden_i) + 1.0 / (3.14159265 * alpha);
}

// MIS weight of a direction sampled with density `pdf`, which the other strategy samples with density `other` (Veach
// 1997, section 9.2.4).
float power_heuristic(float pdf, float other) {
    float ratio = other / pdf;
    return 1.0 / (1.0 + ratio * ratio);
}

#endif
