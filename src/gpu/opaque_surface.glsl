#ifndef PELLUCID_GPU_OPAQUE_SURFACE_GLSL
#define PELLUCID_GPU_OPAQUE_SURFACE_GLSL

// Light of the environment that an opaque surface reflects, as src/reference/bsdf.h has it: the metallic-roughness
// material of glTF 2.0, its diffuse layer under a coat. No shadows, and no light from other surfaces.
// Needs: what gpu/filtered_environment.glsl and gpu/texture.glsl need.
#include "gpu/coat.glsl"
#include "gpu/diffuse.glsl"
#include "gpu/filtered_environment.glsl"
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

// Radiance towards the viewer; `normal` is on the viewer's side. Both directions are unit, in world space.
vec3 opaque_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    float cos_theta = clamp(dot(normal, to_viewer), 1e-4, 1.0);
    float root = (surface.ior - 1.0) / (surface.ior + 1.0), coat_at_normal = root * root;
    vec3 at_normal = mix(vec3(coat_at_normal), surface.base_color, surface.metallic);
    // Where nothing is reflected head-on there is no boundary to reflect at grazing angles either.
    vec3 at_grazing = vec3(greaterThan(at_normal, vec3(0.0)));
    float coat = coat_reflectance(surface.ior, cos_theta);

    vec3 radiance = diffuse_radiance((1.0 - surface.metallic) * (1.0 - coat) * surface.base_color, normal);
    if (at_grazing == vec3(0.0)) return radiance;
    vec3 facets = facet_reflection(cos_theta, surface.roughness);
    vec3 mirrored = 2.0 * dot(normal, to_viewer) * normal - to_viewer;
    // Seen aslant, the lobe is narrower across by the cosine, until it is so wide that it fills the hemisphere; and so
    // much the more does its middle count, rather than its peak. Weights chosen by comparison with the path tracer.
    float alpha = surface.roughness * surface.roughness;
    vec3 lobe = normalize(mix(normal, mirrored, mix(1.0, facets.z, alpha)));
    float roughness = surface.roughness * pow(cos_theta, 0.25 * (1.0 - alpha));
    return radiance + (at_normal * facets.x + at_grazing * facets.y) * filtered_environment_radiance(lobe, roughness);
}

vec3 emitted_radiance(MaterialRecord material, vec2 first_set, vec2 second_set) {
    return material.emission.rgb * sample_texture(material.emission_texture, first_set, second_set).rgb;
}

// Radiance towards the viewer of a place on a surface with texture coordinates of two sets; `base` is its base colour
// with textures. Emission is added.
vec3 opaque_material_radiance(MaterialRecord material, vec3 base, vec2 first_set, vec2 second_set, vec3 normal,
                              vec3 to_viewer) {
    if ((material.flags & PELLUCID_MATERIAL_UNLIT) != 0u) return base;
    vec2 factors = sample_texture(material.metallic_roughness_texture, first_set, second_set).bg;
    OpaqueSurface surface = OpaqueSurface(base, material.metallic * factors.x, material.roughness * factors.y, material.ior);
    return opaque_radiance(surface, normal, to_viewer) + emitted_radiance(material, first_set, second_set);
}

#endif
