#ifndef PELLUCID_SHADE_SRGB_GLSL
#define PELLUCID_SHADE_SRGB_GLSL

// sRGB transfer curve (IEC 61966-2-1); input and output 0..1.
vec3 srgb_from_linear(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

#endif
