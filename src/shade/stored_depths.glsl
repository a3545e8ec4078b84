#ifndef PELLUCID_SHADE_STORED_DEPTHS_GLSL
#define PELLUCID_SHADE_STORED_DEPTHS_GLSL

// The published thickness (Chen, sections 0 and 1.3): depths that one texel of the light's map stores are compared with
// the depth of the visible point. Needs what solid_on_ray.glsl needs, and light_view.

// Depth of the ray through the texel's centre on a triangle, as a depth buffer stores it, m along the light's view axis.
float stored_depth(uint triangle, uint object, ivec2 texel) {
    uint corner = objects[object].first_corner + 3u * (triangle - objects[object].first_triangle);
    mat4 view_from_object = light_view.view_from_world * objects[object].world_from_object;
    vec3 a = (view_from_object * vec4(vertex_position(indices[corner]), 1.0)).xyz;
    vec3 b = (view_from_object * vec4(vertex_position(indices[corner + 1u]), 1.0)).xyz;
    vec3 c = (view_from_object * vec4(vertex_position(indices[corner + 2u]), 1.0)).xyz;
    vec2 film = light_view.film.xy + vec2(1.0, -1.0) * (vec2(texel) + 0.5) * light_view.film.zw;
    vec3 normal = cross(b - a, c - a);
    if (light_view.orthographic != 0u) return -dot(normal, a - vec3(film, 0.0)) / normal.z;
    return dot(normal, a) / dot(normal, vec3(film, -1.0));
}

// The first and second depth bound the first solid, the third and fourth the second, up to the first depth that is not
// in front of the point. A last depth without a partner is an entry, and does not count. A map of one layer is a shadow
// map: everything behind its depth is solid.
SolidOnRay solid_in_stored_depths(ivec2 texel, vec3 in_view) {
    SolidOnRay solid = SolidOnRay(0.0, vec3(0.0), false, false);
    float end = -in_view.z, entry = 0.0;
    float metres = light_view.orthographic != 0u ? 1.0 : length(in_view) / end;  // along the ray, per depth
    vec3 sigma = vec3(0.0);
    bool ended = false;
    for (uint layer = 0u; layer < layer_count && !ended; ++layer) {
        uint word = imageLoad(layer_triangle, ivec3(texel, layer)).r;
        if (word == PELLUCID_NO_TRIANGLE) return solid;
        uint triangle = triangle_index(word), object = find_object(triangle);
        float depth = stored_depth(triangle, object, texel);
        ended = depth >= end;
        MaterialRecord material = materials[objects[object].material];
        if (material.translucent == 0u) {
            solid.shadowed = !ended;
            return solid;
        }
        bool leaves = (layer & 1u) != 0u;
        if (!leaves) entry = depth, sigma = material.sigma_a.rgb;
        if (!leaves && layer_count > 1u) continue;
        float inside = max((leaves ? depth : end) - entry, 0.0) * metres;
        solid.thickness += inside;
        solid.optical_depth += inside * sigma;
    }
    solid.cut = !ended && layer_count > 1u;
    return solid;
}

#endif
