#ifndef PELLUCID_TECHNIQUES_WANG_2014_FIRST_SURFACE_GLSL
#define PELLUCID_TECHNIQUES_WANG_2014_FIRST_SURFACE_GLSL

// Intersection of a pixel's view ray with the object. Needs: ray_state.glsl.

layout(set = 0, binding = 12, r32ui) readonly uniform uimage2DArray seen_triangle;  // layer 0 of all solids together

bool sees_object(ivec2 texel) {
    uint seen = imageLoad(seen_triangle, ivec3(texel, 0)).r;
    return seen != PELLUCID_NO_TRIANGLE && find_object(triangle_index(seen)) == object;
}

// The ray behind the first surface. Its status is kStatusOk if it is inside the object.
Path pass_first_surface(ivec2 texel) {
    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    path.position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
    path.direction = mat3(frame.world_from_view) * path.direction;

    Fragment first = load_fragment(texel, 0u);
    MaterialRecord material = object_material();
    vec3 position = (frame.world_from_view * vec4(view_position(pixel, first.depth), 1.0)).xyz;
    bool leaving = back_face(first.triangle);
    // The entry before an exit may be missing: an open mesh, or the eye inside.
    if (leaving) travel(path, distance(path.position, position), material.sigma_a.rgb);
    path.position = position;
    path.status = leaving ? kStatusMissingLayer : kStatusOk;
    cross_interface(path, unpack_unit_vector(imageLoad(layer_normal, ivec3(texel, 0)).r), leaving, material.ior);
    return path;
}

#endif
