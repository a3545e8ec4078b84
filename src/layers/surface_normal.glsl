#ifndef PELLUCID_LAYERS_SURFACE_NORMAL_GLSL
#define PELLUCID_LAYERS_SURFACE_NORMAL_GLSL

// Normals of layer records, interpolated between the triangle's vertices.
// Needs: frame (FrameConstants), objects (ObjectRecord[]), gpu/vertices.glsl, layers/objects.glsl.

// Weights of a triangle's corners where a line meets its plane (Moeller & Trumbore 1997); kept to the triangle,
// which a rasteriser's rounding can leave a little. `a` is the first corner seen from the line's origin.
vec3 corner_weights(vec3 direction, vec3 a, vec3 edge_b, vec3 edge_c) {
    vec3 p = cross(direction, edge_c), q = cross(a, edge_b);
    float determinant = dot(edge_b, p);
    vec2 w = vec2(-dot(a, p), -dot(direction, q)) / determinant;
    if (!(abs(w.x) + abs(w.y) < 1e6)) w = vec2(1.0 / 3.0);  // the triangle is seen edge-on
    w = max(w, vec2(0.0));
    w /= max(w.x + w.y, 1.0);
    return vec3(1.0 - w.x - w.y, w);
}

// Unit world normal of a fragment at a pixel coordinate, octahedral.
uint surface_normal(vec2 pixel, uint triangle) {
    ObjectRecord object = objects[find_object(triangle_index(triangle))];
    uint corner = object.first_corner + 3u * (triangle_index(triangle) - object.first_triangle);
    uint a = indices[corner], b = indices[corner + 1u], c = indices[corner + 2u];

    // The view ray in the mesh's frame: the inverse of the object's linear part is the normal matrix, transposed.
    Ray ray = camera_ray(pixel);
    mat3 object_from_world = transpose(mat3(object.world_from_object_normal));
    vec3 world_origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    vec3 origin = object_from_world * (world_origin - object.world_from_object[3].xyz);
    vec3 direction = object_from_world * (mat3(frame.world_from_view) * ray.direction);

    vec3 at_a = vertex_position(a);
    vec3 weights = corner_weights(direction, at_a - origin, vertex_position(b) - at_a, vertex_position(c) - at_a);
    vec3 normal = weights.x * vertex_normal(a) + weights.y * vertex_normal(b) + weights.z * vertex_normal(c);
    normal = mat3(object.world_from_object_normal) * normal;
    // Opposite normals cancel out somewhere; any will do there.
    return pack_unit_vector(dot(normal, normal) > 1e-30 ? normalize(normal) : vec3(0.0, 1.0, 0.0));
}

#endif
