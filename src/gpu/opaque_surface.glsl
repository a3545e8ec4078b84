#ifndef PELLUCID_GPU_OPAQUE_SURFACE_GLSL
#define PELLUCID_GPU_OPAQUE_SURFACE_GLSL

// Light of the environment that an opaque surface reflects, as src/reference/bsdf.h and finished_bsdf.h have it: the
// metallic-roughness material of glTF 2.0, its diffuse layer under a boundary, and what extensions lay over it. No
// shadows, and no light from other surfaces.
// Needs: kFinishes (bool: some surface has a finish, a normal texture or an occlusion texture), and what
// gpu/filtered_environment.glsl, gpu/finish.glsl and gpu/texture.glsl need.
#include "gpu/coat.glsl"
#include "gpu/diffuse.glsl"
#include "gpu/emitted_radiance.glsl"
#include "gpu/filtered_environment.glsl"
#include "gpu/light_parts.glsl"
#include "gpu/tangent_frame.glsl"
#include "gpu/tangents.glsl"
#include "gpu/texture.glsl"
#include "gpu/finish.glsl"

struct OpaqueSurface {
    vec3 diffuse;     // albedo under the boundary, 0..1
    vec3 at_normal;   // reflectance of facets, head-on
    vec3 at_grazing;  // and at grazing angles
    vec2 boundary;    // reflectance of the boundary over the diffuse layer, likewise
    float roughness;  // perceptual, 0..1
    float occlusion;  // share of the environment's light that arrives
    Layers layers;
};

// Share of light that the boundary over the diffuse layer reflects, by the cosine of its direction.
float boundary_reflectance(OpaqueSurface surface, float cos_theta) {
    return mix(surface.boundary.x, surface.boundary.y, schlick_weight(cos_theta));
}

// Mean of boundary_reflectance() over diffuse light. It is below 1, so that a quotient by what passes stays finite.
float mean_boundary_reflectance(OpaqueSurface surface) {
    return min(surface.boundary.x + (surface.boundary.y - surface.boundary.x) / 21.0, 0.999);
}

// The table of tabulate_facets.comp, bilinear.
vec4 facet_reflection(float cos_theta, float roughness) {
    vec2 position = clamp(vec2(cos_theta, roughness), 0.0, 1.0) * float(kFacetTableSize - 1);
    ivec2 low = min(ivec2(position), ivec2(kFacetTableSize - 2)), at = kFacetTableCorner + low;
    vec2 weight = position - vec2(low);
    return mix(mix(texelFetch(filtered_environment, at, 0), texelFetch(filtered_environment, at + ivec2(1, 0), 0), weight.x),
               mix(texelFetch(filtered_environment, at + ivec2(0, 1), 0),
                   texelFetch(filtered_environment, at + ivec2(1, 1), 0), weight.x), weight.y);
}

bool has_sheen(OpaqueSurface surface) { return kFinishes && surface.layers.sheen != vec3(0.0); }

// Perceptual roughness of the base's lobe. Facets of two widths count as those of the width between.
float round_roughness(OpaqueSurface surface) {
    if (!kFinishes || surface.layers.stretch == 0.0) return surface.roughness;
    return pow(max(surface.roughness * surface.roughness, kLeastStretched) * surface.layers.stretch, 0.25);
}

// The surface without lobes around mirror directions: the base and the clear coat count as perfect mirrors, which
// opaque_reflection() leaves out.
OpaqueSurface without_base_lobe(OpaqueSurface surface) {
    surface.roughness = surface.layers.stretch = 0.0;
    return surface;
}
OpaqueSurface without_lobes(OpaqueSurface surface) {
    surface.layers.coat_roughness = 0.0;
    return without_base_lobe(surface);
}

// What layers leave of light on its way from the base to the viewer.
float under_layers(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    if (!kFinishes) return 1.0;
    float left = 1.0 - coat_share(surface.layers, to_viewer);
    if (has_sheen(surface)) {
        float albedo = facet_reflection(dot(normal, to_viewer), surface.layers.sheen_roughness).a;
        left *= 1.0 - largest(surface.layers.sheen) * min(albedo, 1.0);
    }
    return left;
}

// Share of light that the diffuse layer scatters to the viewer, through all that is over it.
vec3 opaque_diffuse_albedo(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    float cos_theta = clamp(dot(normal, to_viewer), 1e-4, 1.0);
    return under_layers(surface, normal, to_viewer) * (1.0 - boundary_reflectance(surface, cos_theta)) * surface.diffuse;
}

// What the diffuse layer alone scatters towards the viewer.
vec3 opaque_diffuse_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    return surface.occlusion * diffuse_radiance(opaque_diffuse_albedo(surface, normal, to_viewer), normal);
}

// Environment in the lobe of facets with one perceptual roughness. `middle`: whereto the middle of the light lies, see
// tabulate_facets.comp.
vec3 lobe_radiance(vec3 normal, vec3 to_viewer, float cos_theta, float roughness, float middle) {
    vec3 mirrored = 2.0 * dot(normal, to_viewer) * normal - to_viewer;
    // Seen aslant, the lobe is narrower across by the cosine, until it is so wide that it fills the hemisphere; and so
    // much the more does its middle count, rather than its peak. Weights chosen by comparison with the path tracer.
    float alpha = roughness * roughness;
    vec3 lobe = normalize(mix(normal, mirrored, mix(1.0, middle, alpha)));
    return filtered_environment_radiance(lobe, roughness * pow(cos_theta, 0.25 * (1.0 - alpha)));
}

// The same of facets that are wider along a direction: a fan of narrow lobes. Slopes along one direction have the
// distribution (1 + s)/2, s = slope / sqrt(width^2 + slope^2).
vec3 fan_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer, float cos_theta, float middle) {
    const int kLobes = 8;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = 0; k < kLobes; ++k) {
        float s = (2.0 * float(k) + 1.0) / float(kLobes) - 1.0;
        vec3 facet = normalize(normal + surface.layers.stretch * s * inversesqrt(1.0 - s * s) * surface.layers.along);
        float cosine = dot(facet, to_viewer);
        vec3 mirrored = 2.0 * cosine * facet - to_viewer;
        float weight = max(cosine, 0.0) * smoothstep(0.0, 0.2, dot(mirrored, normal));
        if (weight == 0.0) continue;
        sum += weight * lobe_radiance(facet, to_viewer, max(cosine, 1e-4), surface.roughness, middle);
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : lobe_radiance(normal, to_viewer, cos_theta, surface.roughness, middle);
}

// What facets alone reflect to the viewer. Arguments as those of opaque_radiance().
vec3 opaque_facet_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    if (surface.at_grazing == vec3(0.0)) return vec3(0.0);
    float cos_theta = clamp(dot(normal, to_viewer), 1e-4, 1.0);
    bool stretched = kFinishes && surface.layers.stretch > 0.0;
    vec3 facets = facet_reflection(cos_theta, round_roughness(surface)).rgb;
    vec3 light = stretched ? fan_radiance(surface, normal, to_viewer, cos_theta, facets.z)
                           : lobe_radiance(normal, to_viewer, cos_theta, surface.roughness, facets.z);
    vec3 reflected = (surface.at_normal * facets.x + surface.at_grazing * facets.y) * light;
    return kFinishes ? surface.occlusion * under_layers(surface, normal, to_viewer) * reflected : reflected;
}

// What the clear coat alone reflects.
vec3 coat_radiance(OpaqueSurface surface, vec3 to_viewer) {
    Layers layers = surface.layers;
    float cos_theta = clamp(dot(layers.coat_normal, to_viewer), 1e-4, 1.0);
    vec3 facets = facet_reflection(cos_theta, layers.coat_roughness).rgb;
    return surface.occlusion * layers.coat * (kCoatAtNormal * facets.x + facets.y) *
           lobe_radiance(layers.coat_normal, to_viewer, cos_theta, layers.coat_roughness, facets.z);
}

// What fibres alone reflect: of light that comes from about all directions.
vec3 sheen_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer) {
    Layers layers = surface.layers;
    float albedo = min(facet_reflection(dot(normal, to_viewer), layers.sheen_roughness).a, 1.0);
    return surface.occlusion * (1.0 - coat_share(layers, to_viewer)) * diffuse_radiance(layers.sheen * albedo, normal);
}

const float kSmoothAlpha = 1e-4;  // below, facets count as a perfect mirror

bool is_smooth(float roughness) { return roughness * roughness < kSmoothAlpha; }
bool mirrors_perfectly(OpaqueSurface surface) {
    return is_smooth(surface.roughness) && !(kFinishes && surface.layers.stretch > 0.0);
}

// Radiance towards the viewer; `normal` is on the viewer's side. Both directions are unit, in world space. `scattered`,
// `mirrored`: parts of the picture that light belongs to which the surface scatters, and mirrors perfectly.
vec3 opaque_radiance(OpaqueSurface surface, vec3 normal, vec3 to_viewer, uint scattered, uint mirrored) {
    vec3 sum = drawn(scattered, opaque_diffuse_radiance(surface, normal, to_viewer)) +
               drawn(mirrors_perfectly(surface) ? mirrored : scattered, opaque_facet_radiance(surface, normal, to_viewer));
    if (has_sheen(surface)) sum += drawn(scattered, sheen_radiance(surface, normal, to_viewer));
    if (kFinishes && surface.layers.coat > 0.0)
        sum += drawn(is_smooth(surface.layers.coat_roughness) ? mirrored : scattered, coat_radiance(surface, to_viewer));
    return sum;
}

// What layers reflect of a light; see opaque_reflection().
vec3 layer_reflection(OpaqueSurface surface, vec3 normal, vec3 to_viewer, vec3 to_light) {
    Layers layers = surface.layers;
    vec3 reflected = vec3(0.0), m = normalize(to_viewer + to_light);
    if (layers.coat > 0.0) {
        float alpha = layers.coat_roughness * layers.coat_roughness;
        float fresnel = mix(kCoatAtNormal, 1.0, schlick_weight(min(dot(to_viewer, m), 1.0)));
        if (alpha >= kSmoothAlpha && dot(layers.coat_normal, to_light) > 0.0)
            reflected += layers.coat * fresnel *
                         facet_density(tangent_frame(layers.coat_normal), vec2(alpha), to_viewer, to_light);
    }
    if (has_sheen(surface)) {
        float cos_viewer = dot(normal, to_viewer), cos_light = dot(normal, to_light);
        float most = max(facet_reflection(cos_viewer, layers.sheen_roughness).a, 1.0);
        reflected += layers.sheen * ((1.0 - coat_share(layers, to_viewer)) * cos_light / most *
                     sheen_reflection(cos_viewer, cos_light, dot(normal, m), layers.sheen_roughness));
    }
    return reflected;
}

// BRDF times the cosine to the light, for the two unit directions away from the surface; highlights of facets and the
// diffuse layer under the boundary, as src/reference/bsdf.h has them. A perfect mirror has none.
vec3 opaque_reflection(OpaqueSurface surface, vec3 normal, vec3 to_viewer, vec3 to_light) {
    const float kPi = 3.14159265;
    float cos_viewer = max(dot(normal, to_viewer), 1e-4), cos_light = dot(normal, to_light);
    if (cos_light <= 0.0) return vec3(0.0);
    float passes = (1.0 - boundary_reflectance(surface, cos_viewer)) * (1.0 - boundary_reflectance(surface, cos_light)) /
                   (1.0 - mean_boundary_reflectance(surface));
    vec3 reflected = surface.diffuse * (passes * cos_light / kPi);
    float alpha = surface.roughness * surface.roughness;
    if (!mirrors_perfectly(surface)) {
        vec3 m = normalize(to_viewer + to_light);
        vec3 fresnel = mix(surface.at_normal, surface.at_grazing, schlick_weight(min(dot(to_viewer, m), 1.0)));
        if (kFinishes && surface.layers.stretch > 0.0) {
            mat3 frame_ = mat3(surface.layers.along, cross(normal, surface.layers.along), normal);
            vec2 widths = vec2(surface.layers.stretch, max(alpha, kLeastStretched));
            reflected += fresnel * facet_density(frame_, widths, to_viewer, to_light);
        } else {
            float cos_m = dot(normal, m), a2 = alpha * alpha;
            vec3 across = cross(normal, m);  // its length is the sine, without the cancellation of 1 - cos^2
            float d = dot(across, across) + a2 * cos_m * cos_m;
            vec2 cos2 = vec2(cos_viewer * cos_viewer, cos_light * cos_light);
            vec2 lambda = 0.5 * (sqrt(1.0 + a2 * max(1.0 - cos2, 0.0) / cos2) - 1.0);
            reflected += fresnel * (a2 / (kPi * d * d) / (4.0 * cos_viewer * (1.0 + lambda.x + lambda.y)));
        }
    }
    if (!kFinishes) return reflected;
    return under_layers(surface, normal, to_viewer) * reflected + layer_reflection(surface, normal, to_viewer, to_light);
}

#include "gpu/opaque_material.glsl"

#endif
