#ifndef PELLUCID_LAYERS_TRIANGLE_FRAGMENTS_GLSL
#define PELLUCID_LAYERS_TRIANGLE_FRAGMENTS_GLSL

// A rasteriser in a compute shader: the pixel centres that a triangle covers, and the depths there. Neighbouring
// triangles evaluate their common edge with the same bits, so a centre belongs to exactly one of them.
// Needs: frame (FrameConstants).
#include "gpu/camera.glsl"
#include "gpu/vertices.glsl"
#include "layers/fragment_list.glsl"

layout(std430, set = 0, binding = 3) buffer Nodes { uint node_count, nodes_reserved[3]; Node nodes[]; };
layout(set = 0, binding = 4, r32ui) uniform uimage2DArray heads;

// The data of an object that the rasteriser needs.
struct PlacedMesh {
    mat4 world_from_object;
    uint first_triangle;  // of this object, over all objects
    uint first_corner;    // of its mesh, in the indices
    uint mirrored;
    uint reserved;
};

struct ScreenTriangle {
    vec3 view[3];
    vec2 pixel[3];     // corners in pixels of the whole image, in an order that makes the area positive
    vec3 depths;       // of the corners; their inverses for a perspective camera
    ivec2 low, high;   // pixels whose centres may be covered; empty if high < low
    uint record;       // triangle index, with PELLUCID_BACK_FACE
    bool crosses_near; // the triangle crosses the near plane; pixel and depths must not be used
};

ScreenTriangle screen_triangle(PlacedMesh object, uint triangle, ivec2 first, ivec2 end) {
    ScreenTriangle t;
    uint corner = object.first_corner + 3u * (triangle - object.first_triangle);
    bool any_near = false, all_near = true;
    vec2 low = vec2(1e30), high = vec2(-1e30);
    for (int i = 0; i < 3; ++i) {
        vec4 world = object.world_from_object * vec4(vertex_position(indices[corner + uint(i)]), 1.0);
        t.view[i] = (frame.view_from_world * world).xyz;
        bool near = -t.view[i].z < frame.near_plane;
        any_near = any_near || near;
        all_near = all_near && near;
        t.pixel[i] = project_to_picture(t.view[i]);
        t.depths[i] = frame.orthographic != 0u ? -t.view[i].z : -1.0 / t.view[i].z;
        low = min(low, t.pixel[i]);
        high = max(high, t.pixel[i]);
    }
    t.crosses_near = any_near;
    vec2 b = t.pixel[1] - t.pixel[0], c = t.pixel[2] - t.pixel[0];
    bool turned = b.x * c.y < b.y * c.x;
    bool back = !turned;  // pixels count downwards, so a front face has the opposite winding in pixels
    if (any_near) {
        low = vec2(1e30);
        high = vec2(-1e30);
        for (int i = 0; i < 3; ++i) {
            vec3 from = t.view[i], to = t.view[(i + 1) % 3];
            if (-from.z >= frame.near_plane) {
                low = min(low, project_to_picture(from));
                high = max(high, project_to_picture(from));
            }
            if ((-from.z < frame.near_plane) != (-to.z < frame.near_plane)) {
                vec2 cut = project_to_picture(mix(from, to, (frame.near_plane + from.z) / (from.z - to.z)));
                low = min(low, cut);
                high = max(high, cut);
            }
        }
        vec3 normal = cross(t.view[1] - t.view[0], t.view[2] - t.view[0]);
        back = dot(normal, frame.orthographic != 0u ? vec3(0.0, 0.0, -1.0) : t.view[0]) > 0.0;
    } else if (turned) {
        t.pixel = vec2[3](t.pixel[0], t.pixel[2], t.pixel[1]);
        t.depths = t.depths.xzy;
    }
    t.record = triangle | (back != (object.mirrored != 0u) ? PELLUCID_BACK_FACE : 0u);
    low -= vec2(first_pixel());
    high -= vec2(first_pixel());
    // Clamp to the requested part of the image plus a pixel, so that the values fit into integers.
    t.low = max(ivec2(ceil(clamp(low - 0.5, vec2(first) - 1.0, vec2(end)))), first);
    t.high = min(ivec2(floor(clamp(high - 0.5, vec2(first) - 1.0, vec2(end)))), end - 1);
    if (all_near) t.high = t.low - 1;
    return t;
}

// Twice the signed area of triangle abp; positive if a, b, p turn from x towards y. `turned`: evaluated from b to a, so
// that both neighbours of an edge compute the same bits.
float edge(vec2 a, vec2 b, vec2 p, out bool turned) {
    turned = b.x < a.x || (b.x == a.x && b.y < a.y);
    vec2 from = turned ? b : a, to = turned ? a : b;
    precise float area = (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    return turned ? -area : area;
}

// Whether the triangle covers the pixel's centre, and its depth there.
bool covered_at(ScreenTriangle t, ivec2 pixel, out float depth) {
    vec2 p = vec2(pixel + first_pixel()) + 0.5;
    bvec3 turned;
    vec3 areas = vec3(edge(t.pixel[1], t.pixel[2], p, turned.x), edge(t.pixel[2], t.pixel[0], p, turned.y),
                      edge(t.pixel[0], t.pixel[1], p, turned.z));
    float interpolated = dot(areas, t.depths) / (areas.x + areas.y + areas.z);
    depth = frame.orthographic != 0u ? interpolated : 1.0 / interpolated;
    bvec3 inside = bvec3(areas.x > 0.0 || (areas.x == 0.0 && !turned.x), areas.y > 0.0 || (areas.y == 0.0 && !turned.y),
                         areas.z > 0.0 || (areas.z == 0.0 && !turned.z));
    return all(inside) && areas.x + areas.y + areas.z > 0.0;
}

// Like covered_at(), for a triangle that crosses the near plane. Intersects the camera ray with the triangle.
bool met_at(ScreenTriangle t, ivec2 pixel, out float depth) {
    Ray ray = camera_ray(vec2(pixel) + 0.5);
    vec3 b = t.view[1] - t.view[0], c = t.view[2] - t.view[0];
    vec3 p = cross(ray.direction, c), from_corner = ray.origin - t.view[0], q = cross(from_corner, b);
    float determinant = dot(b, p);
    vec2 weights = vec2(dot(from_corner, p), dot(ray.direction, q)) / determinant;
    depth = dot(c, q) / determinant * -ray.direction.z;
    return min(min(weights.x, weights.y), 1.0 - weights.x - weights.y) >= 0.0 && depth >= frame.near_plane;
}

void append_fragment(ivec2 pixel, Fragment fragment) {
    uint node = atomicAdd(node_count, 1u);
    if (node >= nodes.length()) return;  // the fragment is counted, so the host enlarges the pool
    uint next = imageAtomicExchange(heads, ivec3(pixel, 0), node + 1u);
    nodes[node] = Node(fragment, next);
}

#endif
