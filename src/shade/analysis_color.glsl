#ifndef PELLUCID_SHADE_ANALYSIS_COLOR_GLSL
#define PELLUCID_SHADE_ANALYSIS_COLOR_GLSL

// Colours of Wang 2014, figure 4.5: red up to two interfaces, blue more, green total internal reflection. `events`: a
// word of Refraction::events (unpack_events()).
vec3 analysis_color(uint events) {
    if (((events >> 24) & 0xfu) != 0u) return vec3(0.35);  // the technique abandoned the path
    if (((events >> 12) & 0xfffu) > 0u) return vec3(0.1, 0.7, 0.15);
    return (events & 0xfffu) > 2u ? vec3(0.1, 0.2, 0.9) : vec3(0.85, 0.1, 0.08);
}

#endif
