#ifndef PELLUCID_GPU_COAT_GLSL
#define PELLUCID_GPU_COAT_GLSL

// Schlick, "An inexpensive BRDF model for physically-based rendering", 1994.
float schlick_weight(float cos_theta) {
    float grazing = 1.0 - cos_theta, squared = grazing * grazing;
    return squared * squared * grazing;
}

// Share of light that the coat of an opaque surface reflects; `ior` 1: there is none.
float coat_reflectance(float ior, float cos_theta) {
    float root = (ior - 1.0) / (ior + 1.0), at_normal = root * root;
    return at_normal > 0.0 ? mix(at_normal, 1.0, schlick_weight(cos_theta)) : 0.0;
}

// Its mean over diffuse light.
float mean_coat_reflectance(float ior) {
    float root = (ior - 1.0) / (ior + 1.0), at_normal = root * root;
    return at_normal > 0.0 ? at_normal + (1.0 - at_normal) / 21.0 : 0.0;
}

#endif
