#ifndef PELLUCID_LAYERS_SURFACE_NORMAL_GLSL
#define PELLUCID_LAYERS_SURFACE_NORMAL_GLSL

// Normals of layer records, interpolated between the triangle's vertices.
// Needs: frame (FrameConstants), objects (ObjectRecord[]), gpu/vertices.glsl.

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

// The view ray through a pixel coordinate in the frame of an object's mesh. The inverse of the object's linear part
// is its normal matrix, transposed.
Ray object_ray(vec2 pixel, uint object_index) {
    Ray ray = camera_ray(pixel);
    vec3 world_origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    mat3 object_from_world = transpose(mat3(objects[object_index].world_from_object_normal));
    return Ray(object_from_world * (world_origin - objects[object_index].world_from_object[3].xyz),
               object_from_world * (mat3(frame.world_from_view) * ray.direction));
}

// Unit world normal where such a ray meets a triangle of the object, octahedral.
uint surface_normal(Ray ray, uint triangle, uint object_index) {
    uint corner =
        objects[object_index].first_corner + 3u * (triangle_index(triangle) - objects[object_index].first_triangle);
    uint a = indices[corner], b = indices[corner + 1u], c = indices[corner + 2u];
    vec3 at_a = vertex_position(a);
    vec3 weights =
        corner_weights(ray.direction, at_a - ray.origin, vertex_position(b) - at_a, vertex_position(c) - at_a);
    vec3 normal = weights.x * vertex_normal(a) + weights.y * vertex_normal(b) + weights.z * vertex_normal(c);
    normal = mat3(objects[object_index].world_from_object_normal) * normal;
    // Opposite normals cancel out somewhere; any will do there.
    return pack_direction(dot(normal, normal) > 1e-30 ? normal : vec3(0.0, 1.0, 0.0));
}

#endif
