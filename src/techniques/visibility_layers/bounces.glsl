#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_BOUNCES_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_BOUNCES_GLSL

// Light that opaque surfaces send to each other: branches of the path, or a cache of irradiance.
// Needs: look_at_lights.glsl.
#include "light/irradiance_points.glsl"

// A diffuse reflection sees the environment a little blurred, against noise of small suns: by 2 degrees. A wider blur brings
// light from above a horizon to surfaces that see only what is below it.
const float kBounceRoughness = 1.0 / float(PELLUCID_FILTER_LEVELS);

// A direction in which a surface looks to what is around it.
struct Bounce {
    vec3 direction;  // unit
    vec3 weight;     // of the radiance from there
    float alpha;     // of the lobe from which it was chosen; 0: a perfect mirror's
    bool diffuse;
};

Bounce diffuse_bounce(OpaquePoint point, vec3 to_viewer, vec2 u) {
    float radius = sqrt(u.x), angle = 6.283185307 * u.y;
    vec3 direction = tangent_frame(point.normal) * vec3(radius * cos(angle), radius * sin(angle), sqrt(max(1.0 - u.x, 0.0)));
    // The coat lets light in as opaque_reflection() has it: less of what comes aslant.
    float passes = 1.0 - boundary_reflectance(point.surface, sqrt(max(1.0 - u.x, 0.0)));
    vec3 weight = diffuse_albedo(point, to_viewer) * (passes / (1.0 - mean_boundary_reflectance(point.surface)));
    return Bounce(direction, weight, kBounceRoughness * kBounceRoughness, true);
}

// By a facet that is visible from the path's side (Heitz 2018). The weight is 0 where the facet sends light into the surface.
Bounce facet_bounce(vec3 normal, float roughness, vec3 at_normal, vec3 at_grazing, vec3 to_viewer, vec2 u) {
    float alpha = roughness * roughness;
    if (alpha < kSmoothAlpha) alpha = 0.0;
    FacetReflection reflected = reflect_by_facet(normal, to_viewer, alpha, u);
    vec3 fresnel = mix(at_normal, at_grazing, schlick_weight(clamp(reflected.cosine, 0.0, 1.0)));
    return Bounce(reflected.direction, fresnel * reflected.visible, alpha, false);
}

// One of the base's facets, or of the clear coat's, at random by their weights. Facets of two widths count as round ones
// of the width between.
Bounce outer_bounce(OpaquePoint point, vec3 to_viewer, vec2 u, inout float choice) {
    OpaqueSurface surface = point.surface;
    if (!kFinishes) return facet_bounce(point.normal, surface.roughness, surface.at_normal, surface.at_grazing, to_viewer, u);
    Layers layers = surface.layers;
    Bounce base = facet_bounce(point.normal, round_roughness(surface), surface.at_normal, surface.at_grazing, to_viewer, u);
    base.weight *= under_layers(surface, point.normal, to_viewer);
    if (layers.coat == 0.0) return base;
    Bounce coat = facet_bounce(layers.coat_normal, layers.coat_roughness, vec3(layers.coat * kCoatAtNormal), vec3(layers.coat), to_viewer, u);
    // A tilted coat may reflect to below the surface.
    if (dot(coat.direction, point.normal) <= 0.0) coat.weight = vec3(0.0);
    float share = largest(coat.weight) / max(largest(coat.weight) + largest(base.weight), 1e-20);
    bool by_coat = choice < share;
    choice = by_coat ? choice / share : (choice - share) / max(1.0 - share, 1e-20);
    if (by_coat) base = coat;
    base.weight /= by_coat ? share : 1.0 - share;
    return base;
}

// One of the two, at random by their weights; facets only where all light is followed, and then with a chance of `least`, where
// they reflect at all: the light that is taken off for them is bright, whatever they send instead.
Bounce choose_bounce(OpaquePoint point, vec3 to_viewer, vec2 u, float choice, float least) {
    Bounce diffuse = diffuse_bounce(point, to_viewer, u);
    if (!kFullLight || point.unlit) return diffuse;
    Bounce facet = outer_bounce(point, to_viewer, u, choice);
    float share = largest(facet.weight) / max(largest(facet.weight) + largest(diffuse.weight), 1e-20);
    if (point.surface.boundary.y > 0.0 && share < 1.0) share = max(share, least);
    bool by_facet = choice < share;
    if (by_facet) diffuse = facet;
    diffuse.weight /= by_facet ? share : 1.0 - share;
    return diffuse;
}

// Marks of a path that leaves a surface.
uint mark_of_bounce(PathState state, OpaquePoint point, Bounce chosen) {
    uint mark = without_spread(state.mark) & ~(kMainPath | kMetOpaque | kBounceMask | kBounced | kUnbent | kFromDiffuse | kFromGlass);
    mark |= (bounces(state) + 1u) << kBounceShift;
    bool as_photon = !chosen.diffuse && mirrors_photons(state, point);
    if (chosen.diffuse || as_photon) mark |= kFromDiffuse;
    // A mirror's path sees lights; others leave these to shadow rays.
    if (chosen.alpha > 0.0) mark = widened(mark | kBounced, chosen.alpha);
    mark = after_surface(mark, chosen.alpha > 0.0);
    bool bent = as_photon && (kPhotonsOfEmitters || kPhotonsOfEnvironment);
    return chosen.alpha > 0.0 && !bent ? mark | kUnbent : mark;
}

// Whether shadow rays follow the environment to the surface which the path has left.
bool shadow_rays_have(PathState state) {
    bool by_facets = kConverges && has_mark(state, kBounced) && spread_of(state.mark) > 0.99 * kWideAlpha;
    return kEnvironmentRays && has_mark(state, kUnbent) && (by_facets || has_mark(state, kFromDiffuse));
}

// Sends a branch from the surface to what is there instead of the environment. What it finds counts, less what was assumed:
// surfaces that stand alone stay as they are, without noise.
void send_bounce(ivec2 texel, PathState state, OpaquePoint point, Bounce chosen, vec3 weight) {
    uint mark = state.mark;
    state.path.direction = chosen.direction;
    state.path.transmittance = weight;
    state.mark = mark_of_bounce(state, point, chosen);
    float roughness = sqrt(spread_of(state.mark));
    bool assumed = !(kPhotonsOfEnvironment && photons_have(state)) && !shadow_rays_have(state);
    if (push_branch(state, branch_capacity, true) && assumed)
        add_light(texel, mark, drawn(part_met(state.mark), -weight * filtered_environment_radiance(chosen.direction, roughness)));
}

// Light from other surfaces, of one direction or, where the cache knows it, of all.
void bounce(ivec2 texel, PathState state, OpaquePoint point, CachedLight known) {
    uint branches_before = waiting[state.pixel].y, before = bounces(state);
    if (before >= most_bounces) return;
    uint seed = hash(uvec3(texel + first_pixel(), 77u + branches_before + 256u * before)).x;
    vec2 u = random_numbers(seed, state.path.events);
    vec3 diffuse = state.path.transmittance * diffuse_albedo(point, -state.path.direction);
    bool cached = kFullLight && kCachedFrom <= before && known.known;
    if (cached) add_light(texel, state.mark, drawn(PELLUCID_INDIRECT, diffuse * known.irradiance / 3.14159265));
    if (branches_before >= max(most_branches, most_bounces)) return;
    Bounce chosen = choose_bounce(point, -state.path.direction, u, random_number(seed, state.path.events), cached ? 0.5 : 0.25);
    vec3 weight = state.path.transmittance * chosen.weight;
    if (largest(weight) > threshold && !(cached && chosen.diffuse)) send_bounce(texel, state, point, chosen, weight);
}

const float kIndirectPoints = 0.25;  // share of the points at which others' rays end, which the eye need not see

// Sends a path that looks for a point on from a surface.
void look_on(PathState state, Bounce chosen, uint mark) {
    ++state.path.events;
    state.path.direction = chosen.direction;
    state.mark = mark;
    push_branch(state, branch_capacity, true);
}

// Samples the irradiance of the first diffuse surface that the path meets, also behind mirrors, or of one that this surface sees.
void gather(ivec2 texel, PathState state, OpaquePoint point) {
    uint seed = hash(uvec3(texel + first_pixel(), 76u)).x;
    Bounce chosen = choose_bounce(point, -state.path.direction, random_numbers(seed, state.path.events),
                                  random_number(seed, state.path.events), 0.0);
    if (!(largest(chosen.weight) > 0.0)) return;
    uint mark = state.mark & ~kMetOpaque;
    if (!chosen.diffuse) {
        if (state.path.events + 1u < max_events) look_on(state, chosen, mark);
    } else if (bounces(state) == 0u && random_number(seed ^ 0x2c1b3c6du, state.path.events) < kIndirectPoints) {
        look_on(state, chosen, mark | 1u << kBounceShift);
    } else {
        points[state.pixel] = IrradiancePoint(state.path.position, pack_direction(point.normal));
        state.mark &= ~kBounceMask;
        send_bounce(texel, state, point, chosen, vec3(3.14159265));
        if (kEnvironmentRays) look_for_sky(texel, state, point);
    }
}

#endif
