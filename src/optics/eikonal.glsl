#ifndef PELLUCID_OPTICS_EIKONAL_GLSL
#define PELLUCID_OPTICS_EIKONAL_GLSL

// Light rays where the index of refraction varies (Ihrke et al. 2007, sections 4.1 and 4.2). Twin of eikonal.h, which
// says what the equations are.
//
// Needs: vec4 index_field(vec3 x): the gradient of the index, and the index.

struct CurvedRay {
    vec3 x;
    vec3 v;  // n times the unit direction
};

// Steps of equal length in space.
CurvedRay space_slope(CurvedRay ray) {
    vec4 field = index_field(ray.x);
    return CurvedRay(ray.v / field.w, field.xyz);
}

// Steps of equal optical time: length times n.
CurvedRay time_slope(CurvedRay ray) {
    vec4 field = index_field(ray.x);
    return CurvedRay(ray.v / (field.w * field.w), field.xyz / field.w);
}

CurvedRay advanced(CurvedRay ray, float h, CurvedRay slope) {
    return CurvedRay(ray.x + h * slope.x, ray.v + h * slope.v);
}

// First order. Names follow `slope`: euler_space_step, rk4_space_step, euler_time_step, rk4_time_step.
// RK4: the classical method of Runge and Kutta; fourth order where n has five derivatives.
#define PELLUCID_RAY_STEPS(euler, rk4, slope)                             \
    CurvedRay euler(CurvedRay ray, float h) { return advanced(ray, h, slope(ray)); } \
    CurvedRay rk4(CurvedRay ray, float h) {                               \
        CurvedRay a = slope(ray);                                         \
        CurvedRay b = slope(advanced(ray, 0.5 * h, a));                   \
        CurvedRay c = slope(advanced(ray, 0.5 * h, b));                   \
        CurvedRay d = slope(advanced(ray, h, c));                         \
        return CurvedRay(ray.x + h / 6.0 * (a.x + d.x) + h / 3.0 * (b.x + c.x), \
                         ray.v + h / 6.0 * (a.v + d.v) + h / 3.0 * (b.v + c.v)); \
    }
PELLUCID_RAY_STEPS(euler_space_step, rk4_space_step, space_slope)
PELLUCID_RAY_STEPS(euler_time_step, rk4_time_step, time_slope)

#endif
