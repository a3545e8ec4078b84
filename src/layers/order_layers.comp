#version 460
// Joins both sides of dual depth peeling into one list: the near side forwards, then the far side backwards (Chen).
// Writes the first layers of the list. Counts missing peels and crowded pixels, which make the list wrong.
#extension GL_GOOGLE_include_directive : require
#include "layers/dual_peel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) readonly uniform image2DArray near_side;
layout(set = 0, binding = 1, rgba32f) readonly uniform image2DArray far_side;
layout(set = 0, binding = 2, r32f) readonly uniform image2DArray opaque_depth;
layout(set = 0, binding = 3, r32f) writeonly uniform image2DArray layer_depth;
layout(set = 0, binding = 4, r32ui) writeonly uniform uimage2DArray layer_triangle;
layout(std430, set = 0, binding = 5) buffer PeelCounters {
    uint extra_peels;  // peels that the image needs beyond half the layers
    uint crowded;      // pixels where three surfaces or more lie at one depth
};
layout(push_constant) uniform Push {
    uint layer_count;
    uint hidden_by_opaque;
    uint peels;
};

uint written = 0u;

void write_layer(ivec2 texel, float depth, uint triangle) {
    if (written == layer_count) return;
    imageStore(layer_depth, ivec3(texel, written), vec4(depth));
    imageStore(layer_triangle, ivec3(texel, written), uvec4(triangle));
    ++written;
}

// Writes the surfaces at one depth. False if there are more than two: only the lowest and highest triangle are known.
bool write_layers(ivec2 texel, float depth, vec4 triangles) {
    if (triangles.a > 2.0) return false;
    write_layer(texel, depth, lowest_triangle(triangles));
    if (triangles.a > 1.0) write_layer(texel, depth, highest_triangle(triangles));
    return true;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(near_side).xy))) return;
    float first_depth = -imageLoad(near_side, ivec3(texel, 0)).r;
    if (first_depth == PELLUCID_EMPTY_DEPTH) return;
    if (hidden_by_opaque != 0u && first_depth >= imageLoad(opaque_depth, ivec3(texel, 0)).r) return;

    // Count the peels until the two sides met, or until the near side alone had enough layers.
    uint used = 0u, found = 0u;
    bool met = false;
    while (used < peels && !met && found < layer_count) {
        vec4 next = imageLoad(near_side, ivec3(texel, ++used));
        found += uint(next.a);
        met = -next.r == PELLUCID_EMPTY_DEPTH;
    }
    bool complete = met || found >= layer_count;
    uint needed = complete ? used : layer_count, half_of_layers = (layer_count + 1u) / 2u;
    if (needed > half_of_layers) atomicMax(extra_peels, needed - half_of_layers);
    if (!complete) return;

    bool known = true;
    for (uint i = 0u; i < used && written < layer_count && known; ++i) {
        float depth = -imageLoad(near_side, ivec3(texel, i)).r;
        known = write_layers(texel, depth, imageLoad(near_side, ivec3(texel, i + 1u)));
    }
    for (uint i = used; i-- > 0u && written < layer_count && known;) {
        float depth = imageLoad(far_side, ivec3(texel, i)).r;
        if (depth == -imageLoad(near_side, ivec3(texel, i)).r) continue;  // nearest and farthest at once
        known = write_layers(texel, depth, imageLoad(far_side, ivec3(texel, i + 1u)));
    }
    if (!known) atomicAdd(crowded, 1u);
}
