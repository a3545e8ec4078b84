#ifndef PELLUCID_LAYERS_PLACE_TRIANGLE_GLSL
#define PELLUCID_LAYERS_PLACE_TRIANGLE_GLSL

// Writes triangles in the format that rays read (surface_map.glsl). Needs: objects, vertices.glsl.
layout(std430, set = 0, binding = 4) writeonly buffer MapTriangles { vec4 map_triangles[]; };
layout(std430, set = 0, binding = 10) writeonly buffer MapNormals { vec4 map_normals[]; };

// Returns the corners `v` in the map's space. They are counter-clockwise seen from outside, also for mirrored objects.
void place_triangle(uint triangle, uint corner, mat4 space_from_object, mat3 normals_from_object, bool mirrored,
                    out vec3 v[3]) {
    uvec3 corners = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    if (mirrored) corners.yz = corners.zy;
    for (int i = 0; i < 3; ++i) {
        v[i] = (space_from_object * vec4(vertex_position(corners[i]), 1.0)).xyz;
    }
    map_triangles[3u * triangle] = vec4(v[0], 0.0);
    map_triangles[3u * triangle + 1u] = vec4(v[1] - v[0], 0.0);
    map_triangles[3u * triangle + 2u] = vec4(v[2] - v[0], 0.0);
    for (int i = 0; i < 3; ++i) map_normals[3u * triangle + i] = vec4(normals_from_object * vertex_normal(corners[i]), 0.0);
}

// `triangle` counts over all objects.
void place_in_world(uint triangle, uint object, out vec3 v[3]) {
    ObjectRecord o = objects[object];
    place_triangle(triangle, o.first_corner + 3u * (triangle - o.first_triangle), o.world_from_object,
                   mat3(o.world_from_object_normal), o.mirrored != 0u, v);
}

#endif
