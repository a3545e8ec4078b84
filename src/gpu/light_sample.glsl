#ifndef PELLUCID_GPU_LIGHT_SAMPLE_GLSL
#define PELLUCID_GPU_LIGHT_SAMPLE_GLSL

// A point of a light, as a surface sees it. Needs: gpu/punctual_light.glsl.

struct LightSample {
    vec3 to_light;    // unit
    float distance_;  // m; kFarLight: a sun's
    vec3 irradiance;  // W/m2 on a surface that faces it, if nothing is in between
};
const float kFarLight = 1e30;

LightSample sample_light(PunctualLight light, vec3 position, vec2 u) {
    ArrivingLight arriving = arriving_light(light, position);
    float distance_ = light.kind == kDirectionalLight ? kFarLight : distance(position, light.position);
    return LightSample(-arriving.way, distance_, arriving.irradiance * light.intensity);
}

#endif
