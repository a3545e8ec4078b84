#version 460
// Lands patches that have left the volumes on opaque surfaces. Each patch is a grid of rays, which spreads all of its
// power over the area that it covers. A ray leaves a photon where it ends.
//
// With kStraight, the patches are those that lights emit towards volumes. Their straight rays leave photons of negative
// flux on all surfaces. These subtract the light that a surface would get without volumes and shadows.
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "gpu/octahedral.glsl"
#include "light/photons.glsl"
#include "volume/volume_record.glsl"
#include "volume/light_patch.glsl"

layout(std430, set = 0, binding = 0) readonly buffer OpaqueNodes { OpaqueNode opaque_nodes[]; };
layout(std430, set = 0, binding = 4) readonly buffer OpaqueTriangles { OpaqueTriangle opaque_triangles[]; };
#include "volume/opaque_tree.glsl"
layout(std430, set = 0, binding = 1) buffer State { LightState state; };
#include "volume/light_power.glsl"
layout(std430, set = 0, binding = 2) readonly buffer Landed { LightPatch landed[]; };
layout(std430, set = 0, binding = 3) buffer Photons { uint photon_count, photon_reserved[3]; Photon photons[]; };

layout(std430, set = 0, binding = 5) readonly buffer Fronts { LightFront fronts[]; };

layout(constant_id = 0) const bool kStraight = false;  // trace patches as the light emits them

const uint kMostSurfaces = 16u;  // most surfaces along a straight ray
const float kKernelWidth = 2.0;  // radius of a kernel, in spacings of photons
const float kLeastCosine = 0.1;

// Lengths of the sides of a patch, at the distance t from its corners.
vec2 sides_at(Quad quad, float t) {
    vec3 x[4];
    for (int k = 0; k < 4; ++k) x[k] = quad.x[k] + t * quad.v[k];
    return vec2(max(distance(x[0], x[1]), distance(x[3], x[2])), max(distance(x[0], x[3]), distance(x[1], x[2])));
}

float cosine_of(OpaqueHit hit, vec3 direction) {
    return max(abs(dot(normalize(hit.normal), direction)), kLeastCosine);
}

// The number of rays along both sides that spaces photons by photon_spacing where the patch's centre lands. A patch of
// little power gets fewer rays.
ivec2 rays_of(Quad quad, float slack) {
    if (opaque_count == 0u) return ivec2(1);
    float most = most_photons * max(quad.power.r, max(quad.power.g, quad.power.b)) / fronts[quad.front].intensity.w;
    if (most <= 1.0) return ivec2(1);
    vec3 direction = normalize(quad.v[0] + quad.v[1] + quad.v[2] + quad.v[3]);
    OpaqueHit hit = first_opaque(0.25 * (quad.x[0] + quad.x[1] + quad.x[2] + quad.x[3]), direction, -slack, 1e30);
    if (hit.t >= 1e30) return ivec2(sqrt(most));
    vec2 wanted = max(sides_at(quad, hit.t) / (photon_spacing * cosine_of(hit, direction)), vec2(1.0));
    return ivec2(max(ceil(wanted * min(1.0, sqrt(most / (wanted.x * wanted.y))) - 1e-3), vec2(1.0)));
}

// A number of a photon that does not depend on the order of photons. Crowded slots of the grid select photons by it.
uint number_of(vec3 position, vec3 flux) {
    uvec3 bits = hash(floatBitsToUint(position));
    return hash(bits ^ floatBitsToUint(flux)).x;
}

void add_photon(vec3 position, vec3 direction, OpaqueHit hit, float spacing, vec3 flux) {
    uint number = atomicAdd(photon_count, 1u);
    if (number >= uint(photons.length())) return;  // the photon is counted, so the light is traced again
    float radius = kKernelWidth * spacing * inversesqrt(cosine_of(hit, direction));
    radius = clamp(radius, least_radius, least_radius * float(1 << (kPhotonLevels - 1)));
    vec3 normal = normalize(faceforward(hit.normal, direction, hit.normal));
    photons[number] = Photon(position, radius, flux, pack_direction(normal), photon_level(least_radius, radius), hit.object,
                             number_of(position, flux), 0u);
}

// Leaves negative photons on all surfaces that a ray meets.
void land_straight(Quad quad, ivec2 rays, vec3 position, vec3 direction, vec3 power) {
    float from = 0.0;
    for (uint i = 0u; i < kMostSurfaces; ++i) {
        OpaqueHit hit = first_opaque(position, direction, from, 1e30);
        if (hit.t >= 1e30) return;
        vec2 spacing = sides_at(quad, hit.t) / vec2(rays);
        add_photon(position + hit.t * direction, direction, hit, max(spacing.x, spacing.y), -power);
        from = hit.t * 1.00001 + 1e-3 * photon_spacing;
    }
}

// Leaves a photon on the first surface that a ray meets. False if it meets none.
bool land(Quad quad, ivec2 rays, vec3 position, vec3 direction, float slack, vec3 power) {
    OpaqueHit hit = first_opaque(position, direction, -slack, 1e30);
    if (hit.t >= 1e30) return false;
    vec2 spacing = sides_at(quad, hit.t) / vec2(rays);
    add_photon(position + hit.t * direction, direction, hit, max(spacing.x, spacing.y), power);
    return true;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= (kStraight ? state.in_kept : state.landing)) return;
    Quad quad = unpack_patch(landed[i]);
    for (int k = 0; k < 4; ++k) quad.v[k] = normalize(quad.v[k]);
    float slack = kStraight ? 0.0 : max(distance(quad.x[0], quad.x[2]), distance(quad.x[1], quad.x[3]));
    ivec2 rays = rays_of(quad, slack);
    vec3 power = quad.power / float(rays.x * rays.y);
    vec3 arrived = vec3(0.0), missed = vec3(0.0);
    for (int ray = 0; ray < rays.x * rays.y; ++ray) {
        vec2 at = (vec2(ray % rays.x, ray / rays.x) + 0.5) / vec2(rays);
        vec3 x = mix(mix(quad.x[0], quad.x[1], at.x), mix(quad.x[3], quad.x[2], at.x), at.y);
        vec3 v = normalize(mix(mix(quad.v[0], quad.v[1], at.x), mix(quad.v[3], quad.v[2], at.x), at.y));
        if (kStraight)
            land_straight(quad, rays, x, v, power);
        else if (land(quad, rays, x, v, slack, power))
            arrived += power;
        else
            missed += power;
    }
    if (kStraight) return;
    add_power(PELLUCID_LIGHT_ARRIVED, arrived);
    add_power(PELLUCID_LIGHT_MISSED, missed);
    add_power(PELLUCID_LIGHT_ABSORBED, quad.unabsorbed - quad.power);
}
