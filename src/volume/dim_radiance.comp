#version 460
// Dims the image behind wavefronts.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform image2DArray radiance;
layout(push_constant) uniform Push { float factor; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    imageStore(radiance, at, vec4(factor * imageLoad(radiance, at).rgb, 1.0));
}
