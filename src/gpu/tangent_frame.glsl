#ifndef PELLUCID_GPU_TANGENT_FRAME_GLSL
#define PELLUCID_GPU_TANGENT_FRAME_GLSL

// A right-handed frame whose z axis is the unit normal.
mat3 tangent_frame(vec3 normal) {
    vec3 across = normalize(abs(normal.z) < 0.9 ? cross(normal, vec3(0.0, 0.0, 1.0)) : cross(normal, vec3(1.0, 0.0, 0.0)));
    return mat3(across, cross(normal, across), normal);
}

#endif
