#ifndef PELLUCID_GPU_THIN_FILM_GLSL
#define PELLUCID_GPU_THIN_FILM_GLSL

// Reflectance of a surface under a film as thin as waves of light: Belcour & Barla, "A practical extension to microfacet
// theory for the modeling of varying iridescence", 2017, with Schlick's Fresnel terms (KHR_materials_iridescence).
// Needs: gpu/coat.glsl.

// Fourier transform of the eye's sensitivities in linear Rec.709; `difference`: of optical paths, m. The paper's supplement
// has the Gaussians.
vec3 film_sensitivity(float difference, vec3 shift) {
    const float kTwoPi = 6.283185307;
    float phase = kTwoPi * difference;
    vec3 peak = vec3(5.4856e-13, 4.4201e-13, 5.2481e-13) / 1.0685e-7, position = vec3(1.6810e6, 1.7953e6, 2.2084e6);
    vec3 variance = vec3(4.3278e9, 9.3046e9, 6.6121e9);
    vec3 xyz = peak * sqrt(kTwoPi * variance) * cos(position * phase + shift) * exp(-variance * phase * phase);
    xyz.x += 9.7470e-14 / 1.0685e-7 * sqrt(kTwoPi * 4.5282e9) * cos(2.2399e6 * phase + shift.x) *
             exp(-4.5282e9 * phase * phase);
    return mat3(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259, -0.4985314, 0.0415560, 1.0572252) * xyz;
}

vec3 film_reflectance(float cos_theta, float film_ior, float thickness_nm, vec3 at_normal) {
    const float kPi = 3.14159265;
    if (thickness_nm <= 0.0) return mix(at_normal, vec3(1.0), schlick_weight(cos_theta));
    float n = mix(1.0, film_ior, smoothstep(0.0, 0.03, thickness_nm));
    float cos2 = 1.0 - (1.0 - cos_theta * cos_theta) / (n * n);
    if (cos2 < 0.0) return vec3(1.0);
    float cos_film = sqrt(cos2), root = (n - 1.0) / (n + 1.0);
    float r12 = mix(root * root, 1.0, schlick_weight(cos_theta)), t121 = 1.0 - r12;
    vec3 roots = sqrt(clamp(at_normal, 0.0, 0.9999)), base_ior = (1.0 + roots) / (1.0 - roots);
    vec3 below = (base_ior - n) / (base_ior + n);
    vec3 r23 = mix(below * below, vec3(1.0), schlick_weight(cos_film));
    vec3 shift = kPi + kPi * vec3(lessThan(base_ior, vec3(n)));
    vec3 r123 = clamp(r12 * r23, 1e-5, 0.9999), first = t121 * t121 * r23 / (1.0 - r123);
    vec3 sum = r12 + first, term = first - t121;
    float difference = 2.0 * n * thickness_nm * 1e-9 * cos_film;
    for (int order = 1; order <= 2; ++order) {
        term *= sqrt(r123);
        sum += 2.0 * term * film_sensitivity(float(order) * difference, float(order) * shift);
    }
    return clamp(sum, 0.0, 1.0);
}

#endif
