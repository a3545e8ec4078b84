#ifndef PELLUCID_GPU_PUNCTUAL_LIGHT_GLSL
#define PELLUCID_GPU_PUNCTUAL_LIGHT_GLSL

// KHR_lights_punctual; twin of src/reference/punctual_lights.h.
const uint kDirectionalLight = 0u, kPointLight = 1u, kSpotLight = 2u;  // pellucid::Light::Kind

struct PunctualLight {
    vec3 position;
    uint kind;
    vec3 direction;  // unit, along the light
    float inverse_range;
    vec3 intensity;
    float radius;  // m, of point and spot lights
    float cos_inner, cos_outer;
    float half_angle;  // radians, of directional lights
};

struct ArrivingLight {
    vec3 way;          // unit, along the light
    float irradiance;  // on a surface that faces the light, per intensity; 0: no light arrives
};

ArrivingLight arriving_light(PunctualLight light, vec3 position) {
    if (light.kind == kDirectionalLight) return ArrivingLight(light.direction, 1.0);
    vec3 from_light = position - light.position;
    float distance_ = length(from_light);
    if (!(distance_ > 0.0)) return ArrivingLight(light.direction, 0.0);
    vec3 way = from_light / distance_;
    float relative = distance_ * light.inverse_range, squared = relative * relative;
    float share = clamp(1.0 - squared * squared, 0.0, 1.0);
    if (light.kind == kSpotLight) {
        float cos_angle = dot(way, light.direction);
        float ramp = clamp((cos_angle - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
        share *= ramp * ramp;
    }
    return ArrivingLight(way, share / (distance_ * distance_));
}

#endif
