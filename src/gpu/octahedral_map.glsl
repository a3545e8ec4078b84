#ifndef PELLUCID_GPU_OCTAHEDRAL_MAP_GLSL
#define PELLUCID_GPU_OCTAHEDRAL_MAP_GLSL

// Square maps of all directions. An image holds several maps; `corner` is a map's first texel, `size` its side.
// Includers need `#extension GL_EXT_samplerless_texture_functions : require`.
#include "gpu/octahedral.glsl"

// Wraps a texel across an edge. A map continues at the same edge, mirrored about the edge's centre.
ivec2 wrap_octahedral(ivec2 i, int size) {
    if (i.x < 0 || i.x >= size) i = ivec2(i.x < 0 ? -1 - i.x : 2 * size - 1 - i.x, size - 1 - i.y);
    if (i.y < 0 || i.y >= size) i = ivec2(size - 1 - i.x, i.y < 0 ? -1 - i.y : 2 * size - 1 - i.y);
    return i;
}

// Bilinear value of a map in a direction. The shader interpolates, as filtering of 32-bit float images is optional.
vec4 octahedral_map_value(texture2D maps, ivec2 corner, int size, vec3 direction) {
    vec2 position = (0.5 * octahedral_from_direction(direction) + 0.5) * float(size) - 0.5;
    vec2 low = floor(position);
    vec2 weight = position - low;
    ivec2 i = ivec2(low);
    vec4 upper = mix(texelFetch(maps, corner + wrap_octahedral(i, size), 0),
                     texelFetch(maps, corner + wrap_octahedral(i + ivec2(1, 0), size), 0), weight.x);
    vec4 lower = mix(texelFetch(maps, corner + wrap_octahedral(i + ivec2(0, 1), size), 0),
                     texelFetch(maps, corner + wrap_octahedral(i + ivec2(1, 1), size), 0), weight.x);
    return mix(upper, lower, weight.y);
}

// Solid angle (sr) of a texel at a point of the octahedron.
float octahedral_texel_solid_angle(vec3 point, int size) {
    return 4.0 / (float(size) * float(size) * dot(point, point) * length(point));
}

#endif
