#version 460
// Runs the shader side of optics on a table, for comparison with the C++ side.
#extension GL_GOOGLE_include_directive : require
#include "optics/interface.glsl"

layout(local_size_x = 64) in;

struct Case {
    vec4 direction;  // w: eta
    vec4 normal;     // w: distance
};
struct Answer {
    vec4 refracted;  // w: 1 if refracted, 0 under total internal reflection
    vec4 reflected;  // w: Fresnel reflectance
    vec4 transmitted;  // Beer-Lambert with sigma_a = abs(direction)
};
layout(std430, set = 0, binding = 0) readonly buffer Cases { Case cases[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Answers { Answer answers[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= cases.length()) return;
    vec3 direction = cases[i].direction.xyz, normal = cases[i].normal.xyz, refracted;
    float eta = cases[i].direction.w;
    bool passes = refract_direction(direction, normal, eta, refracted);
    answers[i].refracted = vec4(refracted, passes ? 1.0 : 0.0);
    answers[i].reflected = vec4(reflect_direction(direction, normal), fresnel_dielectric(-dot(direction, normal), eta));
    answers[i].transmitted = vec4(beer_lambert(abs(direction), cases[i].normal.w), 0.0);
}
