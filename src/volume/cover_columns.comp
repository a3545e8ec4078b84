#version 460
// Adds up where columns of a grid enter and leave a solid. An invocation processes a block of columns under one
// triangle. A column that enters at height z covers the rest of z's voxel and all voxels above. The shader adds
// differences from voxel to voxel, and the host sums them along the column (mesh_coverage.cpp).
//
// Corners lie on a lattice of 1/256 of a column's width, and edge tests use exact 64-bit integers. So a column at an
// edge crosses exactly one of the two triangles.
layout(local_size_x = 64) in;

struct Block {
    ivec4 corners_ab;       // x and y of two corners, counter-clockwise, in 1/256 column
    ivec2 corner_c;
    ivec2 first_column;
    ivec2 last_column;      // inclusive
    ivec2 sign_and_unused;  // 1: columns enter the solid, -1: they leave it
    vec4 heights;           // of the three corners, voxels
};
layout(std430, set = 0, binding = 0) readonly buffer Blocks { Block blocks[]; };
layout(std430, set = 0, binding = 1) buffer Differences { int differences[]; };  // x, then y, then z
layout(push_constant) uniform Push {
    uint block_count;
    uint samples;    // columns per voxel along x and y
    uint first_row;  // first row of voxels along y in the differences
    uint width;      // size of the differences, voxels
    uint rows;
    uint height;
};

const int kColumn = 256;        // twin of kLattice in mesh_coverage.cpp
const float kFull = 65536.0;    // units of a column through a whole voxel; twin of kFull

// Exactly twice the signed area of (a, b, p), positive if counter-clockwise, as high and low word.
void edge_side(ivec2 a, ivec2 b, ivec2 p, out int high, out uint low) {
    ivec2 along = b - a, to = p - a;
    int high1, low1, high2, low2;
    imulExtended(along.x, to.y, high1, low1);
    imulExtended(along.y, to.x, high2, low2);
    low = uint(low1) - uint(low2);
    high = high1 - high2 - (uint(low1) < uint(low2) ? 1 : 0);
}

// Whether p lies left of the edge. A point on an edge belongs to exactly one of its two triangles.
bool inside_edge(ivec2 a, ivec2 b, ivec2 p, out float weight) {
    int high;
    uint low;
    edge_side(a, b, p, high, low);
    weight = max(float(high) * 4294967296.0 + float(low), 0.0);
    if (high == 0 && low == 0u) return a.x < b.x || (a.x == b.x && a.y < b.y);
    return high >= 0;
}

void main() {
    if (gl_GlobalInvocationID.x >= block_count) return;
    Block block = blocks[gl_GlobalInvocationID.x];
    ivec2 a = block.corners_ab.xy, b = block.corners_ab.zw, c = block.corner_c;
    int sign = block.sign_and_unused.x;
    for (int y = block.first_column.y; y <= block.last_column.y; ++y) {
        for (int x = block.first_column.x; x <= block.last_column.x; ++x) {
            ivec2 p = kColumn * ivec2(x, y) + kColumn / 2;
            vec3 weights;
            bool in_a = inside_edge(b, c, p, weights.x);
            bool in_b = inside_edge(c, a, p, weights.y);
            bool in_c = inside_edge(a, b, p, weights.z);
            if (!(in_a && in_b && in_c)) continue;
            float z = dot(weights, block.heights.xyz) / (weights.x + weights.y + weights.z);
            uint voxel = uint(clamp(int(floor(z)), 0, int(height) - 1));
            int above = int(round(clamp(z - float(voxel), 0.0, 1.0) * kFull));
            uint row = uint(y) / samples - first_row;
            uint at = uint(x) / samples + width * (row + rows * voxel);
            atomicAdd(differences[at], sign * (int(kFull) - above));
            if (voxel + 1u < height) atomicAdd(differences[at + width * rows], sign * above);
        }
    }
}
