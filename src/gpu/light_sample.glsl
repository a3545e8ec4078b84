#ifndef PELLUCID_GPU_LIGHT_SAMPLE_GLSL
#define PELLUCID_GPU_LIGHT_SAMPLE_GLSL

// Sampling of points on a light. Suns are discs of uniform radiance; lamps and spots are balls of uniform radiance.
// Needs: gpu/punctual_light.glsl.
#include "gpu/tangent_frame.glsl"

struct LightSample {
    vec3 to_light;    // unit
    float distance_;  // m; kFarLight for a sun
    vec3 irradiance;  // W/m2 on an unshadowed surface that faces the point
};
const float kFarLight = 1e30;

// 1 - cos, without cancellation at small angles.
float one_minus_cos(float sin_angle) { return sin_angle * sin_angle / (1.0 + sqrt(max(1.0 - sin_angle * sin_angle, 0.0))); }

// Density of the directions of sample_light(), 1/sr; 0 if the light has no size, or if the position is in its ball.
float light_density(PunctualLight light, vec3 position) {
    float half_sine = sin(0.5 * light.half_angle), height = 2.0 * half_sine * half_sine;
    if (light.kind != kDirectionalLight) {
        float sin_half = light.radius / distance(position, light.position);
        height = sin_half < 1.0 ? one_minus_cos(sin_half) : 0.0;
    }
    return height > 0.0 ? 1.0 / (6.283185307 * height) : 0.0;
}

// Samples a direction in the cone around a unit axis, uniform over its solid angle. `height`: 1 - cos of half the
// cone's angle. `sine`: sine of the angle between direction and axis.
vec3 sample_cone(vec3 axis, float height, vec2 u, out float sine) {
    float q = u.x * height, angle = 6.283185307 * u.y;
    sine = sqrt(max(q * (2.0 - q), 0.0));
    return normalize(tangent_frame(axis) * vec3(sine * cos(angle), sine * sin(angle), 1.0 - q));
}

// Samples a point of the light. `u`: 0..1. The mean of the irradiances is that of the whole light on a surface that
// faces its centre.
LightSample sample_light(PunctualLight light, vec3 position, vec2 u) {
    ArrivingLight arriving = arriving_light(light, position);
    LightSample point = LightSample(-arriving.way, kFarLight, arriving.irradiance * light.intensity);
    float sine;
    if (light.kind == kDirectionalLight) {
        float half_sine = sin(0.5 * light.half_angle);
        if (light.half_angle > 0.0) point.to_light = sample_cone(point.to_light, 2.0 * half_sine * half_sine, u, sine);
        return point;
    }
    point.distance_ = distance(position, light.position);
    if (light.radius == 0.0) return point;
    float sin_half = light.radius / point.distance_;
    if (sin_half >= 1.0) return LightSample(point.to_light, 0.0, vec3(0.0));  // inside the ball, where it sends no light
    float height = one_minus_cos(sin_half);
    point.irradiance *= 2.0 * height / (sin_half * sin_half);
    point.to_light = sample_cone(point.to_light, height, u, sine);
    float off = point.distance_ * sine;
    point.distance_ *= sqrt(max(1.0 - sine * sine, 0.0));
    point.distance_ -= sqrt(max(light.radius * light.radius - off * off, 0.0));
    return point;
}

#endif
