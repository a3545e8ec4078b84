#ifndef PELLUCID_GPU_FINISH_GLSL
#define PELLUCID_GPU_FINISH_GLSL

// What extensions of glTF add to opaque surfaces (pellucid::Finish), as src/reference/finished_bsdf.h has it.
// Needs: finishes (FinishRecord[]), gpu/coat.glsl, gpu/tangents.glsl.
#include "gpu/largest.glsl"
#include "gpu/sheen.glsl"
#include "gpu/thin_film.glsl"

const float kCoatAtNormal = 0.04;      // reflectance of a clear coat, of index 1.5
const float kLeastStretched = 1e-3;    // width of facets across the direction of anisotropy

// At a point; all is zero on a plain surface.
struct Layers {
    float coat;
    float coat_roughness;
    vec3 coat_normal;  // unit, on the viewer's side
    vec3 sheen;
    float sheen_roughness;
    float stretch;     // width of facets along `along`; 0: the lobe is round
    vec3 along;        // unit, in the surface
};

const Layers kNoLayers = Layers(0.0, 0.0, vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, 0.0, vec3(1.0, 0.0, 0.0));

// Share of light that a clear coat reflects; 0 where there is none.
float coat_share(Layers layers, vec3 to_viewer) {
    return layers.coat * mix(kCoatAtNormal, 1.0, schlick_weight(clamp(dot(layers.coat_normal, to_viewer), 0.0, 1.0)));
}

// Light reflected by facets, BRDF times cosine over Fresnel reflectance, for directions on the normal's side. GGX with
// Smith's shadowing, heights correlated; widths along x and y of `frame_`, whose z is the normal.
float facet_density(mat3 frame_, vec2 alpha, vec3 to_viewer, vec3 to_light) {
    vec3 o = to_viewer * frame_, i = to_light * frame_, m = normalize(o + i);
    vec2 slope = m.xy / alpha, across_o = alpha * o.xy, across_i = alpha * i.xy;
    float d = dot(slope, slope) + m.z * m.z;
    float lambda_o = 0.5 * (sqrt(1.0 + dot(across_o, across_o) / max(o.z * o.z, 1e-8)) - 1.0);
    float lambda_i = 0.5 * (sqrt(1.0 + dot(across_i, across_i) / max(i.z * i.z, 1e-8)) - 1.0);
    return 1.0 / (3.14159265 * alpha.x * alpha.y * d * d * 4.0 * max(o.z, 1e-4) * (1.0 + lambda_o + lambda_i));
}

#endif
