#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PHOTON_PATHS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PHOTON_PATHS_GLSL

// Differences of paths from a light to paths from the eye. Needs: visibility_bindings.glsl, microfacets.glsl.
//
// A photon stores the distance to its neighbours, m, and its growth along the path, m per m: an isotropic ray
// differential (Igehy, "Tracing ray differentials", 1999). Both are signed and negative behind a focus. They replace
// the length inside media, which photons do not need.

float spacing_unit() { return coincidence * 1e6 / 4096.0; }  // m; 16 bits cover 1e-8 to 16 times the scene's size

// x: m, y: m per m.
vec2 photon_spacing(Path path) { return unpackHalf2x16(floatBitsToUint(path.length_inside)) * vec2(spacing_unit(), 1.0); }

void set_photon_spacing(inout Path path, vec2 spacing) {
    vec2 stored = clamp(spacing / vec2(spacing_unit(), 1.0), vec2(-6e4), vec2(6e4));
    path.length_inside = uintBitsToFloat(packHalf2x16(stored));
}

// Rays focused along one axis stay apart along the other, so the spacing does not fall to 0.
void widen_spacing(inout Path path, float distance) {
    vec2 spacing = photon_spacing(path);
    float grown = distance * spacing.y, there = spacing.x + grown, least = 0.5 * abs(grown);
    if (abs(there) < least) there = there < 0.0 ? -least : least;
    set_photon_spacing(path, vec2(there, spacing.y));
}

// Widens the spacing after a random decision of probability `chance`: photons with the same decision are farther
// apart.
void choose_spacing(inout Path path, float chance) {
    set_photon_spacing(path, photon_spacing(path) * inversesqrt(max(chance, 1e-4)));
}

// Updates the spacing at a boundary of curvature `bend`, 1/m, positive if convex towards the incident light:
// Coddington's equations in the sagittal plane (Born & Wolf, 4.6). The footprint narrows with the cosine. `beyond`:
// the photon is refracted.
void refract_spacing(inout Path path, float cos_theta_i, float eta, float bend, bool beyond, float chance, vec3 normal) {
    vec2 spacing = photon_spacing(path);
    if (beyond) {
        float cos_theta_t = abs(dot(path.direction, normal));
        spacing.y = eta * spacing.y - bend * (cos_theta_t - eta * cos_theta_i) * spacing.x;
        spacing.x *= sqrt(max(cos_theta_t, 0.05) / max(cos_theta_i, 0.05));
    } else {
        spacing.y += 2.0 * bend * spacing.x;
    }
    set_photon_spacing(path, spacing * inversesqrt(max(chance, 1e-4)));
}

// Mean curvature of a triangle with outward unit normals at its corners: half the trace of the normal's derivative,
// 1/m.
float mean_curvature(vec3 normal_a, vec3 normal_b, vec3 normal_c, vec3 edge_b, vec3 edge_c) {
    vec3 area = cross(edge_b, edge_c);
    float squared = max(dot(area, area), 1e-30);
    normal_a = normalize(normal_a);
    return 0.5 * (dot(normalize(normal_b) - normal_a, cross(edge_c, area)) +
                  dot(normalize(normal_c) - normal_a, cross(area, edge_b))) / squared;
}

// Correction of interpolated normals for photons, which travel opposite to eye paths (Veach 1997, section 5.3).
float adjoint_weight(vec3 wi, vec3 wo, vec3 normal, vec3 geometric) {
    float weight = abs(dot(wi, normal) * dot(wo, geometric)) / abs(dot(wi, geometric) * dot(wo, normal));
    return weight < 1e4 ? weight : 0.0;
}

// Random number in [0, 1) that is well distributed over a frame's neighbours, so that the right share of them is
// reflected. It uses Roberts' additive recurrences ("The unreasonable effectiveness of quasirandom sequences", 2018).
float photon_choice(PathState state) {
    const vec2 kSteps[4] = vec2[4](vec2(0.7548776662, 0.5698402910), vec2(0.8191725134, 0.6710436067),
                                   vec2(0.8566748839, 0.7338918566), vec2(0.8812714616, 0.7766393890));
    vec2 texel = vec2(state.pixel % frame.width, state.pixel / frame.width);
    float shift = float(hash(uvec3(frame.sample_index, state.path.events, 91u)).x >> 8u) / 16777216.0;
    return fract(dot(texel, kSteps[state.path.events % 4u]) + shift);
}

// Where colours separate, a photon continues with one of them.
void choose_channel(inout PathState state, bool parts) {
    if (!parts || (state.mark & kChannelMask) != 0u) return;
    uint channel = min(uint(3.0 * random_number(state.seed ^ 0x9e3779b9u, state.path.events)), 2u);
    state.mark |= channel + 1u;
    choose_spacing(state.path, 1.0 / 3.0);
    state.path.transmittance *= 3.0 * vec3(channel == 0u, channel == 1u, channel == 2u);
}

#endif
