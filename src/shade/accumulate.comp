#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(set = 0, binding = 1, rgba32f) uniform image2DArray radiance_sum;
layout(push_constant) uniform Push { uint frame_index; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    vec4 value = imageLoad(radiance, at);
    if (frame_index > 0u) value += imageLoad(radiance_sum, at);
    imageStore(radiance_sum, at, value);
}
