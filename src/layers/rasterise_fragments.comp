#version 460
// Appends the fragments of an object's triangles to the lists of their pixels, as gather_fragments.frag does. Cuts
// large triangles, and triangles that cross the near plane, into tiles for rasterise_fragment_tiles.comp. The tiles
// balance the work of neighbouring invocations.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
#include "layers/triangle_fragments.glsl"
#include "layers/triangle_tiles.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    PlacedMesh object;
    uint triangle_count;
    uint row;  // invocations in a row of the dispatch
    uint first_row, row_end;  // of the image
};

const int kSmall = 32;  // most pixels of a box that one invocation processes; bits of a word

void main() {
    uint number = gl_GlobalInvocationID.y * row + gl_GlobalInvocationID.x;
    if (number >= triangle_count) return;
    uint triangle = object.first_triangle + number;
    ScreenTriangle t = screen_triangle(object, triangle, ivec2(0, first_row), ivec2(frame.width, row_end));
    ivec2 size = t.high - t.low + 1;
    if (size.x <= 0 || size.y <= 0) return;
    if (size.x * size.y <= kSmall && !t.crosses_near) {
        // First find the covered pixels, then append their fragments. Some drivers run the whole loop body in every
        // iteration, and most iterations find no covered pixel.
        uint covered = 0u;
        ivec2 pixel = t.low;
        float depth;
        for (int i = 0; i < size.x * size.y; ++i) {
            covered |= covered_at(t, pixel, depth) ? 1u << i : 0u;
            bool turn = pixel.x == t.high.x;
            pixel = ivec2(turn ? t.low.x : pixel.x + 1, turn ? pixel.y + 1 : pixel.y);
        }
        while (covered != 0u) {
            int i = findLSB(covered);
            covered &= covered - 1u;
            pixel = t.low + ivec2(i % size.x, i / size.x);
            covered_at(t, pixel, depth);
            append_fragment(pixel, Fragment(depth, t.record));
        }
        return;
    }
    cut_into_tiles(triangle, t.low, t.high);
}
