#ifndef PELLUCID_VOLUME_LIGHT_CORNER_GLSL
#define PELLUCID_VOLUME_LIGHT_CORNER_GLSL

// Steps of the corners of patches through the volume that was entered last. Needs: volume/volume_field.glsl,
// volume/box.glsl.

vec3 middle(vec3 corners[4]) { return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]); }

// v of the patch's centre; its length is n.
vec3 mean_v(vec3 v[4]) {
    return normalize(middle(v)) * 0.25 * (length(v[0]) + length(v[1]) + length(v[2]) + length(v[3]));
}

// Steps one corner by the optical length h (leapfrog, second order): half a step straight on, the turn, half a step. A
// step reads the index once. Outside the box n is 1.
void step_corner(inout vec3 x, inout vec3 v, float h) {
    bool was_inside = in_box(x, volume_size);
    vec3 half_way = x + 0.5 * h * v / dot(v, v);
    vec4 field = index_field(half_way);
    if (in_box(half_way, volume_size)) v += h * field.xyz / field.w;
    x = half_way + 0.5 * h * v / dot(v, v);
    bool is_inside = in_box(x, volume_size);
    if (was_inside != is_inside) v = normalize(v) * (is_inside ? field.w : 1.0);
}

#endif
