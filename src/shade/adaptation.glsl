#ifndef PELLUCID_SHADE_ADAPTATION_GLSL
#define PELLUCID_SHADE_ADAPTATION_GLSL

// Shared by the passes of adaptation.h. Krawczyk, Myszkowski, Seidel: Perceptual Effects in Real-time Tone Mapping,
// Spring Conference on Computer Graphics 2005.

#define PELLUCID_ADAPTATION_GROUP 256  // invocations of a summing workgroup

const float kDarkest = 1e-4;    // cd/m2, a moonless night; added before logarithms
const float kBrightest = 1e10;  // cd/m2; the sun's disc has 1.6e9

// Rec.709 luminance in cd/m2, 0..kBrightest. `unit_cd_m2`: luminance of radiance 1.
float luminance_cd_m2(vec3 radiance, float unit_cd_m2) {
    return clamp(unit_cd_m2 * dot(radiance, vec3(0.2126, 0.7152, 0.0722)), 0.0, kBrightest);
}

// Share of the rods in vision at a luminance in cd/m2.
float rod_sensitivity(float luminance) { return 0.04 / (0.04 + luminance); }

#ifdef PELLUCID_ADDS_UP
shared float partial_sums[PELLUCID_ADAPTATION_GROUP];

// Sum over the workgroup, in a fixed order. All invocations must call it, once.
float sum_of_group(float value) {
    uint own = gl_LocalInvocationIndex;
    partial_sums[own] = value;
    for (uint half_size = PELLUCID_ADAPTATION_GROUP / 2; half_size > 0u; half_size /= 2u) {
        barrier();
        if (own < half_size) partial_sums[own] += partial_sums[own + half_size];
    }
    barrier();
    return partial_sums[0];
}
#endif

#endif
