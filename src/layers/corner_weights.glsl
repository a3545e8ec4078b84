#ifndef PELLUCID_LAYERS_CORNER_WEIGHTS_GLSL
#define PELLUCID_LAYERS_CORNER_WEIGHTS_GLSL

// Weights of a triangle's corners where a line meets its plane (Moeller & Trumbore 1997). They are clamped to the
// triangle, because a rasteriser's rounding can put the point slightly outside. `a` is the first corner relative to the
// line's origin.
vec3 corner_weights(vec3 direction, vec3 a, vec3 edge_b, vec3 edge_c) {
    vec3 p = cross(direction, edge_c), q = cross(a, edge_b);
    float determinant = dot(edge_b, p);
    vec2 w = vec2(-dot(a, p), -dot(direction, q)) / determinant;
    if (!(abs(w.x) + abs(w.y) < 1e6)) w = vec2(1.0 / 3.0);  // the triangle is seen edge-on
    w = max(w, vec2(0.0));
    w /= max(w.x + w.y, 1.0);
    return vec3(1.0 - w.x - w.y, w);
}

#endif
