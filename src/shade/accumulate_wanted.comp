#version 460
// Adds a sample to the mean of each pixel that still needs samples.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(set = 0, binding = 1, rgba32f) uniform image2DArray radiance_sum;
layout(set = 0, binding = 2, r32ui) readonly uniform uimage2DArray wanted_samples;
layout(push_constant) uniform Push { uint frame_index; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    uint wanted = imageLoad(wanted_samples, at).r;
    if (frame_index >= wanted) return;
    vec4 value = imageLoad(radiance, at) / float(wanted);
    if (frame_index > 0u) value += imageLoad(radiance_sum, at);
    imageStore(radiance_sum, at, value);
}
