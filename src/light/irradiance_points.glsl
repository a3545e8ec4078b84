#ifndef PELLUCID_LIGHT_IRRADIANCE_POINTS_GLSL
#define PELLUCID_LIGHT_IRRADIANCE_POINTS_GLSL

// Positions at which a frame samples irradiance, one per texel.
struct IrradiancePoint {
    vec3 position;  // m, world
    uint normal;    // unit, packed; kNoIrradiance: the texel has no sample
};
const uint kNoIrradiance = 0xffffffffu;

layout(std430, set = 0, binding = 57) buffer IrradiancePoints { IrradiancePoint points[]; };

#endif
