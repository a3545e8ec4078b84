#ifndef PELLUCID_VOLUME_LIGHT_SURFACE_GLSL
#define PELLUCID_VOLUME_LIGHT_SURFACE_GLSL

// Reflection of patches by surfaces in volumes, computed at the patch's centre. Needs: gpu/octahedral.glsl,
// volume/smoothed_surface.glsl.

// Packs a direction, within 0.01 degrees, into the bits of a float that is neither 0 nor infinite.
float pack_way(vec3 way) {
    vec2 place = clamp(octahedral_from_direction(way) * 0.5 + 0.5, 0.0, 1.0);
    return uintBitsToFloat(1u << 30 | uint(place.x * 16383.0 + 0.5) << 15 | uint(place.y * 32767.0 + 0.5));
}
vec3 unpack_way(float packed) {
    uint bits = floatBitsToUint(packed);
    vec2 place = vec2(float(bits >> 15 & 0x3fffu) / 16383.0, float(bits & 0x7fffu) / 32767.0);
    return normalize(octahedron_point(place * 2.0 - 1.0));
}

// Share of the light that a surface has reflected. It is above 0 only in the step in which light leaves the surface,
// and 0 for total reflection. Positions and v are those of the patch's centre, before and after the step.
float crossed_surface(inout vec4 surface, float field, bool inside, vec3 x_before, vec3 v_before, vec3 x, vec3 v) {
    Boundary boundary = kNoBoundary;
    if (surface.x != 0.0) boundary = Boundary(true, unpack_way(surface.x) * surface.y, surface.y, surface.z, surface.w);
    float reflectance = 0.0;
    if (passes_boundary(boundary, field, inside)) {
        reflectance = pass_surface(boundary, x, v).reflectance;
        boundary.open = false;
    }
    if (field > kBoundaryEnds && !boundary.open) boundary = open_boundary(x_before, v_before, field);
    surface = boundary.open ? vec4(pack_way(normalize(boundary.v)), boundary.n, boundary.highest, boundary.lowest) : vec4(0.0);
    return reflectance;
}

#endif
