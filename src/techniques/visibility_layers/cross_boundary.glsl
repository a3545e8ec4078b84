#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_BOUNDARY_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_CROSS_BOUNDARY_GLSL

// What a path does at a boundary of glass. Needs: cross_surface.glsl, branch_capacity.

bool refracts_apart(vec3 iors) { return kDispersive && (iors.r != iors.g || iors.b != iors.g); }

// The boundary of two media at which a path stands.
struct Crossing {
    Surface surface;
    bool leaving;       // the shell that is met, along its outward normal
    bool first;         // by a view ray, from the open
    Media here, there;  // what the path is inside of on its side and on the other
    vec3 n_i, n_t;      // indices of refraction of both, per channel
};

// Whether a direction leads to the other side of the triangle.
bool leads_through(Crossing crossing, vec3 direction) {
    return (dot(direction, crossing.surface.geometric) > 0.0) == crossing.leaving;
}

// After the direction has changed at a boundary: the interpolated normal can send a path to the other side of the
// triangle than it means to. It is where it goes.
void settle(inout PathState state, Crossing crossing) {
    bool through = leads_through(crossing, state.path.direction);
    for (uint w = 0u; w < kMediumWords; ++w)
        state.media.words[w] = through ? crossing.there.words[w] : crossing.here.words[w];
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
    bool looks;         // shadow rays bring the light of lights
    uint sources;       // they choose from
    Facets lobe;        // of all facets, for these rays
    float alpha;        // of the lobe that stands for facets elsewhere
    float bending;      // of a facet's tilt, beside reflection
};

#include "techniques/visibility_layers/look_from_glass.glsl"

void branch_off(PathState state, Crossing crossing, Meeting m, vec3 direction, vec3 weight, uint mark) {
    state.path.direction = direction;
    state.path.transmittance = weight;
    state.mark = mark;
    settle(state, crossing);
    if (m.looks) leave_lights(state, crossing, m);
    push_branch(state, branch_capacity, true);
}

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
    m.looks = glass_looks(state, roughness, m.eta) && dot(state.path.direction, m.normal) < 0.0;
    m.sources = sources_from_glass(state, roughness);
    if (m.looks) m.lobe = Facets(tangent_frame(m.normal), looking_alpha(state, roughness, m.bending), 1.0, ~state.seed, state.path.events, 0u);
    m.rough = samples_facets() && roughness > 0.0 &&
              first_facet(m.normal, state.path, state.seed, roughness, m.facets, m.normal);
    m.alpha = samples_facets() ? 0.0 : roughness * roughness;
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
        branch_off(state, crossing, m, way, weight, mark);
    }
    state.mark |= 2u;
}

// In stills that converge, a few of the reflections that carry too little branch off for all of them (Russian roulette).
bool branches_rarely(PathState state, vec3 reflected) {
    float most = largest(reflected);
    return kConverges && most > 0.0 && most <= threshold && waiting[state.pixel].y < most_branches;
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
    bool branches = may_branch(state.pixel, reflected);
    if (branches_rarely(state, reflected)) {
        float share = largest(reflected) / threshold;
        branches = random_number(state.seed ^ 0x3c6ef372u, state.path.events) < share;
        reflected /= share;
        if (!branches) state.path.transmittance *= 1.0 - m.reflectance;
    }
    if (branches) {
        vec3 way = reflect_direction(m.incident, m.normal);
        bool beyond = false;
        if (m.rough) way = leave_facets(way, m.eta, m.facets, beyond);
        if (beyond) reflected *= m.tint;
        uint mark = (state.mark & ~(kChannelMask | kMainPath)) | m.channel;
        if (crossing.first && !beyond) mark |= kOuterBranch;
        branch_off(state, crossing, m, way, reflected, widened(mark, m.alpha));
        state.path.transmittance *= 1.0 - m.reflectance;
    }
    if (parted) state.path.transmittance *= vec3(0.0, 1.0, 0.0);
}

// Takes a path past the boundary between two media, or back from it.
void cross_boundary(inout PathState state, Crossing crossing) {
    if (kFromLight && kDispersive) choose_channel(state, refracts_apart(crossing.n_i) || refracts_apart(crossing.n_t));
    Meeting m = meet(state, crossing);
    if (m.looks) look_from_glass(state, crossing, m);
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
    if (m.looks) leave_lights(state, crossing, m);
}

#endif
