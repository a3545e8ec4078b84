#ifndef PELLUCID_VOLUME_FRONT_COLOR_GLSL
#define PELLUCID_VOLUME_FRONT_COLOR_GLSL

const float kFaintest = 1.0 / 16.0;  // faintest luminance that is shown

float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }

// The colour scale of View::kWavefront, logarithmic in the luminance of the irradiance, W/m2: 1/16 dark blue, 1/4 blue,
// 1 white, 4 orange, 16 and more red.
vec3 front_color(vec3 irradiance) {
    const vec3 kColors[5] = vec3[](vec3(0.01, 0.02, 0.15), vec3(0.03, 0.16, 0.55), vec3(0.70, 0.70, 0.70),
                                   vec3(0.75, 0.28, 0.02), vec3(0.55, 0.01, 0.01));
    float at = clamp(0.5 * log2(max(luminance(irradiance), kFaintest)) + 2.0, 0.0, 4.0);
    int low = min(int(at), 3);
    return mix(kColors[low], kColors[low + 1], at - float(low));
}

#endif
