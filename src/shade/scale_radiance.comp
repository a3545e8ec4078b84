#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray radiance;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2DArray scaled;
layout(push_constant) uniform Push { float scale; };

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID.xy, 0);
    if (any(greaterThanEqual(at.xy, imageSize(radiance).xy))) return;
    imageStore(scaled, at, vec4(scale * imageLoad(radiance, at).rgb, 1.0));
}
