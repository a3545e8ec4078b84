#version 460
// What GGX facets reflect of even light, for Karis, "Real shading in Unreal Engine 4", 2013: with Schlick's Fresnel term
// the share is r * (reflectance head-on) + g * (reflectance at grazing angles); and whereto the middle of the light lies:
// b = 1 in the mirrored direction, 0 along the normal, linear in between. Smith's shadowing, heights correlated, as
// src/reference/microfacet.h has it. And a: what white fibres (gpu/sheen.glsl) reflect of even light.
#extension GL_GOOGLE_include_directive : require
#include "gpu/structs.h"
#include "gpu/filter_levels.glsl"
#include "gpu/sheen.glsl"
#include "gpu/spread_points.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) writeonly uniform image2DArray filtered_environment;

const uint kSamples = 1024u;

// Smith's auxiliary function.
float lambda(vec3 w, float alpha) {
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - w.z * w.z) / (w.z * w.z)) - 1.0);
}

// A normal in proportion to what is seen of it from wo in the plane y = 0: Heitz, "Sampling the GGX distribution of
// visible normals", JCGT 2018, listing 1.
vec3 visible_facet(vec3 wo, float alpha, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * wo.x, 0.0, wo.z));
    vec3 along = vec3(-stretched.z, 0.0, stretched.x);
    float radius = sqrt(u.x), angle = 6.2831853 * u.y, share = 0.5 * (1.0 + stretched.z);
    float x = radius * cos(angle);
    float y = mix(sqrt(max(1.0 - x * x, 0.0)), radius * sin(angle), share);
    vec3 m = vec3(0.0, x, 0.0) + y * along + sqrt(max(1.0 - x * x - y * y, 0.0)) * stretched;
    return normalize(vec3(alpha * m.x, alpha * m.y, max(m.z, 1e-6)));
}

float sheen_albedo(vec3 wo, float roughness) {
    const int kSteps = 32;
    float sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        float z = (float(i) + 0.5) / float(kSteps), radius = sqrt(1.0 - z * z);
        for (int j = 0; j < kSteps; ++j) {
            float angle = (float(j) + 0.5) / float(kSteps) * 3.14159265;
            vec3 wi = vec3(radius * cos(angle), radius * sin(angle), z);
            sum += z * sheen_reflection(wo.z, z, normalize(wo + wi).z, roughness);
        }
    }
    return 6.283185307 * sum / float(kSteps * kSteps);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, ivec2(kFacetTableSize)))) return;
    vec2 place = vec2(texel) / float(kFacetTableSize - 1);
    // Neither of the ends has a middle of the light beside the normal.
    float cos_o = clamp(place.x, 1e-3, 1.0 - 1e-3), alpha = place.y * place.y;
    vec3 wo = vec3(sqrt(1.0 - cos_o * cos_o), 0.0, cos_o);

    vec2 share = vec2(0.0);
    vec3 middle = vec3(0.0);
    for (uint i = 0u; i < kSamples; ++i) {
        vec3 m = visible_facet(wo, alpha, spread_point(i, kSamples));
        float cosine = dot(wo, m);
        vec3 wi = 2.0 * cosine * m - wo;
        if (wi.z <= 0.0) continue;  // light that the next facet would catch
        float seen = (1.0 + lambda(wo, alpha)) / (1.0 + lambda(wo, alpha) + lambda(wi, alpha));
        float grazing = pow(clamp(1.0 - cosine, 0.0, 1.0), 5.0);
        share += seen * vec2(1.0 - grazing, grazing);
        middle += seen * wi;
    }
    // mix(normal, mirrored, b) is to be parallel to `middle`; its mirrored direction is (-sin, cos).
    float b = -middle.x / (middle.z * wo.x - middle.x * (1.0 - wo.z));
    imageStore(filtered_environment, ivec3(kFacetTableCorner + texel, 0), vec4(share / float(kSamples), b, sheen_albedo(wo, place.y)));
}
