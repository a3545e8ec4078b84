#ifndef PELLUCID_SCENE_IRRADIANCE_GLSL
#define PELLUCID_SCENE_IRRADIANCE_GLSL

// Irradiance on a surface with unit normal n, from the coefficients of irradiance_coefficients() in
// pellucid/environment.h (Ramamoorthi & Hanrahan 2001). Never negative.
vec3 irradiance_from_coefficients(vec3 c[9], vec3 n) {
    vec3 irradiance = 0.282095 * c[0];
    irradiance += 0.488603 * (n.y * c[1] + n.z * c[2] + n.x * c[3]);
    irradiance += 1.092548 * (n.x * n.y * c[4] + n.y * n.z * c[5] + n.x * n.z * c[7]);
    irradiance += 0.315392 * (3.0 * n.z * n.z - 1.0) * c[6];
    irradiance += 0.546274 * (n.x * n.x - n.y * n.y) * c[8];
    return max(irradiance, vec3(0.0));
}

#endif
