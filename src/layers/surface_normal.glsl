#ifndef PELLUCID_LAYERS_SURFACE_NORMAL_GLSL
#define PELLUCID_LAYERS_SURFACE_NORMAL_GLSL

// Normals and other vertex attributes of layers, interpolated between the vertices of their triangles.
// Needs: frame (FrameConstants), objects (ObjectRecord[]), gpu/vertices.glsl.
#include "layers/corner_weights.glsl"

// A point of a triangle.
struct SurfacePoint {
    uvec3 corners;  // vertices
    vec3 weights;   // of the corners; they add up to 1
};

// The view ray through a pixel coordinate in the frame of an object's mesh. The inverse of the object's linear part
// is its normal matrix, transposed.
Ray object_ray(vec2 pixel, uint object_index) {
    Ray ray = camera_ray(pixel);
    vec3 world_origin = (frame.world_from_view * vec4(ray.origin, 1.0)).xyz;
    mat3 object_from_world = transpose(mat3(objects[object_index].world_from_object_normal));
    return Ray(object_from_world * (world_origin - objects[object_index].world_from_object[3].xyz),
               object_from_world * (mat3(frame.world_from_view) * ray.direction));
}

// The point where a ray of object_ray() meets a triangle of the object.
SurfacePoint surface_point(Ray ray, uint triangle, uint object_index) {
    uint corner =
        objects[object_index].first_corner + 3u * (triangle_index(triangle) - objects[object_index].first_triangle);
    uvec3 corners = uvec3(indices[corner], indices[corner + 1u], indices[corner + 2u]);
    vec3 a = vertex_position(corners.x);
    return SurfacePoint(corners, corner_weights(ray.direction, a - ray.origin, vertex_position(corners.y) - a,
                                                vertex_position(corners.z) - a));
}

// Unit world normal at that point, octahedral.
uint surface_normal(Ray ray, uint triangle, uint object_index) {
    SurfacePoint point = surface_point(ray, triangle, object_index);
    vec3 normal = point.weights.x * vertex_normal(point.corners.x) + point.weights.y * vertex_normal(point.corners.y) +
                  point.weights.z * vertex_normal(point.corners.z);
    normal = mat3(objects[object_index].world_from_object_normal) * normal;
    // Opposite vertex normals can cancel out. Any normal is valid there.
    return pack_direction(dot(normal, normal) > 1e-30 ? normal : vec3(0.0, 1.0, 0.0));
}

#endif
