#ifndef PELLUCID_GPU_VISIBLE_LIGHTS_GLSL
#define PELLUCID_GPU_VISIBLE_LIGHTS_GLSL

// Lights with a size, as rays see them that no rough surface has scattered: suns are discs at infinity, lamps and spots
// balls that hide what is behind them.
// Needs: scene_lights (PunctualLight[]), kVisibleLights (their number; 0 if none has a size).
#include "gpu/light_sample.glsl"

// Radiance of all suns in a unit direction, W/(m2 sr).
vec3 suns_ahead(vec3 direction) {
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kVisibleLights; ++i) {
        PunctualLight light = scene_lights[i];
        if (light.kind != kDirectionalLight || light.half_angle == 0.0 || dot(direction, light.direction) >= 0.0) continue;
        if (length(cross(direction, light.direction)) > sin(light.half_angle)) continue;
        float half_sine = sin(0.5 * light.half_angle);
        sum += light.intensity / (2.0 * 3.14159265 * 2.0 * half_sine * half_sine);
    }
    return sum;
}

// Distance, m, to the nearest lamp before `limit`, and its radiance, W/(m2 sr); `limit` if there is none.
float lamp_ahead(vec3 origin, vec3 direction, float limit, out vec3 radiance) {
    radiance = vec3(0.0);
    for (uint i = 0u; i < kVisibleLights; ++i) {
        PunctualLight light = scene_lights[i];
        if (light.kind == kDirectionalLight || light.radius == 0.0) continue;
        vec3 to_middle = light.position - origin;
        float along = dot(to_middle, direction), off = length(to_middle - along * direction);
        if (off > light.radius) continue;
        float t = along - sqrt(light.radius * light.radius - off * off);
        if (t < 0.0 || t >= limit) continue;
        limit = t;
        // Cone and range count from the middle of the ball, as they do for what it lights.
        ArrivingLight arriving = arriving_light(light, origin);
        float d2 = dot(to_middle, to_middle);
        radiance = light.intensity * (arriving.irradiance * d2 / (3.14159265 * light.radius * light.radius));
    }
    return limit;
}

#endif
