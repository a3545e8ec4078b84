#ifndef PELLUCID_GPU_VISIBLE_LIGHTS_GLSL
#define PELLUCID_GPU_VISIBLE_LIGHTS_GLSL

// Lights with a size, for rays that no rough surface has scattered. Suns are discs at infinity. Lamps and spots are
// balls that hide surfaces behind them. Needs: scene_lights (PunctualLight[]), kVisibleLights (number of lights; 0 if
// none has a size).
#include "gpu/light_sample.glsl"

// Radiance of a sun in a unit direction, W/(m2 sr).
vec3 sun_ahead(PunctualLight light, vec3 direction) {
    if (light.half_angle == 0.0 || dot(direction, light.direction) >= 0.0) return vec3(0.0);
    if (length(cross(direction, light.direction)) > sin(light.half_angle)) return vec3(0.0);
    float half_sine = sin(0.5 * light.half_angle);
    return light.intensity / (2.0 * 3.14159265 * 2.0 * half_sine * half_sine);
}

// Radiance of all suns in a unit direction, W/(m2 sr).
vec3 suns_ahead(vec3 direction) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kVisibleLights; ++i)
        if (scene_lights[i].kind == kDirectionalLight) sum += sun_ahead(scene_lights[i], direction);
    return sum;
}

// Distance, m, to the ball of a lamp; kFarLight if it is not ahead.
float ball_ahead(PunctualLight light, vec3 origin, vec3 direction) {
    vec3 to_middle = light.position - origin;
    float along = dot(to_middle, direction), off = length(to_middle - along * direction);
    if (light.radius == 0.0 || off > light.radius) return kFarLight;
    float t = along - sqrt(light.radius * light.radius - off * off);
    return t < 0.0 ? kFarLight : t;
}

// Radiance of a lamp, W/(m2 sr). Cone and range are measured from the ball's centre, as in arriving_light().
vec3 ball_radiance(PunctualLight light, vec3 origin) {
    ArrivingLight arriving = arriving_light(light, origin);
    vec3 to_middle = light.position - origin;
    float d2 = dot(to_middle, to_middle);
    return light.intensity * (arriving.irradiance * d2 / (3.14159265 * light.radius * light.radius));
}

// Distance, m, to the nearest lamp before `limit`, and its radiance, W/(m2 sr). Returns `limit` if there is none.
float lamp_ahead(vec3 origin, vec3 direction, float limit, out vec3 radiance) {
    radiance = vec3(0.0);
    for (uint i = 0u; i < kVisibleLights; ++i) {
        if (scene_lights[i].kind == kDirectionalLight) continue;
        float t = ball_ahead(scene_lights[i], origin, direction);
        if (t >= min(limit, kFarLight)) continue;
        limit = t;
        radiance = ball_radiance(scene_lights[i], origin);
    }
    return limit;
}

// Radiance of a light in a unit direction, W/(m2 sr), and its distance, m. The radiance is 0 if the ray misses.
vec3 light_ahead(PunctualLight light, vec3 origin, vec3 direction, out float distance_) {
    distance_ = kFarLight;
    if (light.kind == kDirectionalLight) return sun_ahead(light, direction);
    distance_ = ball_ahead(light, origin, direction);
    return distance_ < kFarLight ? ball_radiance(light, origin) : vec3(0.0);
}

#endif
