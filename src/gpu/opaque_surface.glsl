#ifndef PELLUCID_GPU_OPAQUE_SURFACE_GLSL
#define PELLUCID_GPU_OPAQUE_SURFACE_GLSL

// Light of the environment that an opaque surface reflects, as src/reference/bsdf.h has it: the metallic-roughness
// material of glTF 2.0, its diffuse layer under a coat. No shadows, and no light from other surfaces.
// Needs: what gpu/filtered_environment.glsl and gpu/texture.glsl need.
#include "gpu/coat.glsl"
#include "gpu/diffuse.glsl"
#include "gpu/emitted_radiance.glsl"
#include "gpu/filtered_environment.glsl"
#include "gpu/light_parts.glsl"
#include "gpu/texture.glsl"

struct OpaqueSurface {
    vec3 base_color;  // 0..1
    float metallic;   // 0..1
    float roughness;  // perceptual, 0..1
    float ior;        // of the coat; 1: none
};

// The table of tabulate_facets.comp, bilinear.
vec3 facet_reflection(float cos_theta, float roughness) {
    vec2 position = clamp(vec2(cos_theta, roughness), 0.0, 1.0) * float(kFacetTableSize - 1);
    ivec2 low = min(ivec2(position), ivec2(kFacetTableSize - 2)), at = kFacetTableCorner + low;
    vec2 weight = position - vec2(low);
    return mix(mix(texelFetch(filtered_environment, at, 0), texelFetch(filtered_environment, at + ivec2(1, 0), 0), weight.x),
               mix(texelFetch(filtered_environment, at + ivec2(0, 1), 0),
                   texelFetch(filtered_environment, at + ivec2(1, 1), 0), weight.x), weight.y).rgb;
}

// What the diffuse layer alone scatters towards the viewer.
vec3 opaque_diffuse_radiance(OpaqueSurface surface, vec3 normal, float cos_theta) {
    float coat = coat_reflectance(surface.ior, cos_theta);
    return diffuse_radiance((1.0 - surface.metallic) * (1.0 - coat) * surface.base_color, normal);
}

// What facets alone reflect to the viewer. Arguments as those of opaque_radiance().
vec3 opaque_facet_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    float cos_theta = clamp(dot(normal, to_viewer), 1e-4, 1.0);
    float root = (surface.ior - 1.0) / (surface.ior + 1.0), coat_at_normal = root * root;
    vec3 at_normal = mix(vec3(coat_at_normal), surface.base_color, surface.metallic);
    // Where nothing is reflected head-on there is no boundary to reflect at grazing angles either.
    vec3 at_grazing = vec3(greaterThan(at_normal, vec3(0.0)));
    if (at_grazing == vec3(0.0)) return vec3(0.0);
    vec3 facets = facet_reflection(cos_theta, surface.roughness);
    vec3 mirrored = 2.0 * dot(normal, to_viewer) * normal - to_viewer;
    // Seen aslant, the lobe is narrower across by the cosine, until it is so wide that it fills the hemisphere; and so
    // much the more does its middle count, rather than its peak. Weights chosen by comparison with the path tracer.
    float alpha = surface.roughness * surface.roughness;
    vec3 lobe = normalize(mix(normal, mirrored, mix(1.0, facets.z, alpha)));
    float roughness = surface.roughness * pow(cos_theta, 0.25 * (1.0 - alpha));
    return (at_normal * facets.x + at_grazing * facets.y) * filtered_environment_radiance(lobe, roughness);
}

const float kSmoothAlpha = 1e-4;  // below, facets count as a perfect mirror

bool mirrors_perfectly(OpaqueSurface surface) { return surface.roughness * surface.roughness < kSmoothAlpha; }

// Radiance towards the viewer; `normal` is on the viewer's side. Both directions are unit, in world space. `scattered`,
// `mirrored`: parts of the picture that light belongs to which the surface scatters, and mirrors perfectly.
vec3 opaque_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer, uint scattered, uint mirrored) {
    float cos_theta = clamp(dot(normal, to_viewer), 1e-4, 1.0);
    return drawn(scattered, opaque_diffuse_radiance(surface, normal, cos_theta)) +
           drawn(mirrors_perfectly(surface) ? mirrored : scattered, opaque_facet_radiance(surface, normal, to_viewer));
}

// BRDF times the cosine to the light, for the two unit directions away from the surface; highlights of facets and the
// diffuse layer under the coat, as src/reference/bsdf.h has them. A perfect mirror has none.
vec3 opaque_reflection(OpaqueSurface surface, vec3 normal, vec3 to_viewer, vec3 to_light) {
    const float kPi = 3.14159265;
    float cos_viewer = max(dot(normal, to_viewer), 1e-4), cos_light = dot(normal, to_light);
    if (cos_light <= 0.0) return vec3(0.0);
    float root = (surface.ior - 1.0) / (surface.ior + 1.0), coat_at_normal = root * root;
    float passes = (1.0 - coat_reflectance(surface.ior, cos_viewer)) * (1.0 - coat_reflectance(surface.ior, cos_light)) /
                   (1.0 - mean_coat_reflectance(surface.ior));
    vec3 reflected = (1.0 - surface.metallic) * surface.base_color * (passes * cos_light / kPi);
    float alpha = surface.roughness * surface.roughness;
    if (alpha < kSmoothAlpha) return reflected;
    vec3 m = normalize(to_viewer + to_light);
    float cos_m = dot(normal, m), a2 = alpha * alpha;
    vec3 across = cross(normal, m);  // its length is the sine, without the cancellation of 1 - cos^2
    float d = dot(across, across) + a2 * cos_m * cos_m;
    vec2 cos2 = vec2(cos_viewer * cos_viewer, cos_light * cos_light);
    vec2 lambda = 0.5 * (sqrt(1.0 + a2 * max(1.0 - cos2, 0.0) / cos2) - 1.0);
    vec3 at_normal = mix(vec3(coat_at_normal), surface.base_color, surface.metallic);
    vec3 fresnel = mix(at_normal, vec3(greaterThan(at_normal, vec3(0.0))), schlick_weight(min(dot(to_viewer, m), 1.0)));
    return reflected + fresnel * (a2 / (kPi * d * d) / (4.0 * cos_viewer * (1.0 + lambda.x + lambda.y)));
}

// Of a material at texture coordinates of two sets; `base` is its base colour with textures.
OpaqueSurface opaque_surface(MaterialRecord material, vec3 base, vec2 first_set, vec2 second_set) {
    vec2 factors = sample_texture(material.metallic_roughness_texture, first_set, second_set).bg;
    return OpaqueSurface(base, material.metallic * factors.x, material.roughness * factors.y, material.ior);
}

// Radiance towards the viewer, who sees it directly, of a place on a surface with texture coordinates of two sets; `base`
// is its base colour with textures. Emission is added.
vec3 opaque_material_radiance(MaterialRecord material, vec3 base, vec2 first_set, vec2 second_set, vec3 normal,
                              vec3 to_viewer) {
    if ((material.flags & PELLUCID_MATERIAL_UNLIT) != 0u) return drawn(PELLUCID_EMITTED, base);
    return opaque_radiance(opaque_surface(material, base, first_set, second_set), normal, to_viewer, PELLUCID_DIRECT, PELLUCID_EMITTED) +
           drawn(PELLUCID_EMITTED, emitted_radiance(material, first_set, second_set));
}

#endif
