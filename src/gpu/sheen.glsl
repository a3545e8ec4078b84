#ifndef PELLUCID_GPU_SHEEN_GLSL
#define PELLUCID_GPU_SHEEN_GLSL

// Fibres on a surface: Estevez & Kulla, "Production friendly microfacet sheen BRDF", 2017.

const float kSmoothestSheen = 0.1;  // fibres of less roughness are seen nowhere but at the silhouette

// The paper's fit of Smith's auxiliary function.
float sheen_lambda(float cos_theta, float alpha) {
    float t = (1.0 - alpha) * (1.0 - alpha), x = cos_theta < 0.5 ? cos_theta : 1.0 - cos_theta;
    float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), c = mix(0.19823, 0.16801, t);
    float d = mix(-1.97760, -1.27393, t), e = mix(-4.32054, -4.85967, t);
    float l = a / (1.0 + b * pow(x, c)) + d * x + e, half_ = a / (1.0 + b * pow(0.5, c)) + d * 0.5 + e;
    return exp(cos_theta < 0.5 ? l : 2.0 * half_ - l);
}

// BRDF of white fibres, by the cosines of both directions and of the vector half between them to the normal.
float sheen_reflection(float cos_o, float cos_i, float cos_m, float roughness) {
    float r = max(roughness, kSmoothestSheen), alpha = r * r, power = 1.0 / alpha;
    float density = (2.0 + power) * pow(max(1.0 - cos_m * cos_m, 0.0), 0.5 * power) / 6.283185307;
    cos_o = max(cos_o, 1e-4);
    cos_i = max(cos_i, 1e-4);
    return density / ((1.0 + sheen_lambda(cos_o, alpha) + sheen_lambda(cos_i, alpha)) * 4.0 * cos_o * cos_i);
}

#endif
