#ifndef PELLUCID_TECHNIQUES_KAY_GREENBERG_1979_SURFACE_LIGHT_GLSL
#define PELLUCID_TECHNIQUES_KAY_GREENBERG_1979_SURFACE_LIGHT_GLSL

// Light from the scene's lights on one surface, in world space. Every surface sees every light, without shadows
// (section 4.1). Needs: optics/interface.glsl.
#include "gpu/punctual_light.glsl"

layout(std430, set = 0, binding = 14) readonly buffer SceneLights { PunctualLight scene_lights[]; };

const float kLightPi = 3.14159265;

struct LitSurface {
    vec3 position;
    vec3 normal;   // unit, on the viewer's side
    vec3 to_eye;   // unit
    float ior;
    float alpha;  // width of the GGX lobe
};

struct SurfaceLight {
    vec3 irradiance;  // arriving on the viewer's side, W/m2
    vec3 highlight;   // radiance towards the eye
};

// GGX lobe of a dielectric with Smith's height-correlated shadowing (Heitz 2014), times the cosine to the light.
float highlight_of(LitSurface surface, vec3 to_light, float cos_light) {
    vec3 middle = normalize(to_light + surface.to_eye);
    float cos_eye = max(dot(surface.normal, surface.to_eye), 1e-4), cos_facet = dot(surface.normal, middle);
    float alpha2 = surface.alpha * surface.alpha;
    float spread = cos_facet * cos_facet * (alpha2 - 1.0) + 1.0;
    float density = alpha2 / (kLightPi * spread * spread);
    float shadowing = cos_light * sqrt(cos_eye * cos_eye * (1.0 - alpha2) + alpha2) +
                      cos_eye * sqrt(cos_light * cos_light * (1.0 - alpha2) + alpha2);
    return density * fresnel_dielectric(dot(middle, surface.to_eye), 1.0 / surface.ior) * 0.5 * cos_light / shadowing;
}

SurfaceLight light_on(LitSurface surface, uint light_count) {
    SurfaceLight sum = SurfaceLight(vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < light_count; ++i) {
        ArrivingLight arriving = arriving_light(scene_lights[i], surface.position);
        float cos_light = -dot(arriving.way, surface.normal);
        if (!(cos_light > 0.0)) continue;
        vec3 facing = scene_lights[i].intensity * arriving.irradiance;  // irradiance on a surface facing the light
        sum.irradiance += cos_light * facing;
        sum.highlight += highlight_of(surface, -arriving.way, cos_light) * facing;
    }
    return sum;
}

#endif
