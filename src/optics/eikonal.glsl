#ifndef PELLUCID_OPTICS_EIKONAL_GLSL
#define PELLUCID_OPTICS_EIKONAL_GLSL

// Light rays in a varying index of refraction (Ihrke et al. 2007, sections 4.1 and 4.2). Twin of eikonal.h, which
// gives the equations.
//
// Needs: vec4 index_field(vec3 x), which returns the gradient of the index (xyz) and the index (w).

struct CurvedRay {
    vec3 x;
    vec3 v;  // n times the unit direction
};

// Derivative with respect to length.
CurvedRay space_slope(CurvedRay ray) {
    vec4 field = index_field(ray.x);
    return CurvedRay(ray.v / field.w, field.xyz);
}

// Derivative with respect to optical time, which is length times n.
CurvedRay time_slope(CurvedRay ray) {
    vec4 field = index_field(ray.x);
    return CurvedRay(ray.v / (field.w * field.w), field.xyz / field.w);
}

CurvedRay advanced(CurvedRay ray, float h, CurvedRay slope) {
    return CurvedRay(ray.x + h * slope.x, ray.v + h * slope.v);
}

// Euler's method is of first order. RK4, the classical method of Runge and Kutta, is of fourth order where n has five
// derivatives. The functions are euler_space_step, rk4_space_step, euler_time_step and rk4_time_step.
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

vec3 ray_force(vec3 x) {
    vec4 field = index_field(x);
    return field.w * field.xyz;
}

// Second order, with one field evaluation.
CurvedRay leapfrog_step(CurvedRay ray, float distance_along) {
    float h = distance_along / length(ray.v);
    vec3 middle = ray.x + 0.5 * h * ray.v;
    vec3 v = ray.v + h * ray_force(middle);
    return CurvedRay(middle + 0.5 * h * v, v);
}

// Fourth order, with three field evaluations.
CurvedRay nystrom_step(CurvedRay ray, float distance_along) {
    float h = distance_along / length(ray.v);
    vec3 a = ray_force(ray.x);
    vec3 b = ray_force(ray.x + 0.5 * h * ray.v + 0.125 * h * h * a);
    vec3 c = ray_force(ray.x + h * ray.v + 0.5 * h * h * b);
    return CurvedRay(ray.x + h * ray.v + h * h / 6.0 * (a + 2.0 * b), ray.v + h / 6.0 * (a + 4.0 * b + c));
}

const uint kEuler = 0u, kRungeKutta = 1u, kLeapfrog = 2u, kNystrom = 3u;

CurvedRay space_step(uint integrator, CurvedRay ray, float distance_along) {
    if (integrator == kEuler) return euler_space_step(ray, distance_along);
    if (integrator == kLeapfrog) return leapfrog_step(ray, distance_along);
    if (integrator == kNystrom) return nystrom_step(ray, distance_along);
    return rk4_space_step(ray, distance_along);
}

#endif
