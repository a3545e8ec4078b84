#ifndef PELLUCID_SHADE_SOLID_ON_RAY_GLSL
#define PELLUCID_SHADE_SOLID_ON_RAY_GLSL

// Thickness of solid on a light ray in front of its end point (Chen, translucency by measured thickness).
//
// A texel of a light's map names the triangles crossed by the ray through its centre. The ray to the point differs
// from that by less than a texel. This file intersects the ray itself with the triangles' planes. Depths are therefore
// exact for the point's own ray, and need no bias against neighbouring texels. All distances are relative to the
// point, in metres along the light, negative in front of the point. Needs: objects, materials, gpu/vertices.glsl,
// layers/layers.glsl, layers/objects.glsl, layer_triangle, layer_count, kOneObject.

// A visible point, and the light that arrives at it.
struct LitPoint {
    vec3 world;
    vec3 way;  // unit, direction of travel of the light
    uint object;
    vec3 in_mesh;  // position in the frame of the object's mesh
    vec3 way_in_mesh;
    uint triangle;  // triangle that contains the point
    bool leaving;   // the light leaves the solid at the point
};

struct SolidOnRay {
    float thickness;     // m
    vec3 optical_depth;  // sum of c d
    bool shadowed;       // an opaque object is in front
    bool cut;            // more surfaces in front than layers
};

// Intersection of the light ray with the plane of a triangle.
struct Crossing {
    float at;         // m from the point
    float tan_theta;  // tangent of the angle between the plane and one facing the light
};

// Intersects the triangle's plane. The result is clamped to the triangle's range, extended by its length on both
// sides, because edge-on planes intersect far away.
Crossing crossing(uint triangle, uint object, LitPoint point) {
    vec3 from = point.in_mesh, way = point.way_in_mesh;
    if (!kOneObject && object != point.object) {
        mat3 object_from_world = transpose(mat3(objects[object].world_from_object_normal));
        from = object_from_world * (point.world - objects[object].world_from_object[3].xyz);
        way = object_from_world * point.way;
    }
    uint corner = objects[object].first_corner + 3u * (triangle - objects[object].first_triangle);
    vec3 a = vertex_position(indices[corner]) - from;
    vec3 b = vertex_position(indices[corner + 1u]) - from;
    vec3 c = vertex_position(indices[corner + 2u]) - from;
    vec3 normal = cross(b - a, c - a);
    float speed = dot(normal, way), at = dot(normal, a) / speed;
    vec3 along = vec3(dot(a, way), dot(b, way), dot(c, way)) / dot(way, way);
    float low = min(along.x, min(along.y, along.z)), high = max(along.x, max(along.y, along.z));
    float extent = high - low;
    at = at == at ? clamp(at, low - extent, high + extent) : low;  // 0 / 0: the ray lies in the plane
    return Crossing(at, length(cross(normal, way)) / max(abs(speed), 1e-30));
}

// Accumulated lengths in solids, and the open solid.
struct Tally {
    float thickness;
    vec3 optical_depth;
    float entry;  // entry into the open solid
    vec3 sigma;
};
void close_solid(inout Tally tally, float at) {
    float inside = max(at - tally.entry, 0.0);
    tally.thickness += inside;
    tally.optical_depth += inside * tally.sigma;
}

// Thickness from the layers of a texel. The light is in a solid while its entries outnumber its exits. Unpaired
// entries and exits contribute nothing. They occur on open meshes, and at silhouettes, where the texel's ray crosses a
// solid that the point's ray misses. An unpaired exit is skipped. An unpaired entry is recognised only at the end;
// `above` therefore sums the solids as if the outermost entry did not exist. A visible point lies where its light
// leaves the last solid, or outside.
//
// No bias separates the point's own surface from others. Where the light enters at the point, the own surface is
// unpaired, and where it leaves, the length is the same. Only on the lit side, in a crease, may the exit of a solid in
// front lie behind the point, by less than a texel. `own` bounds this error for the point's surface and for surfaces
// that meet it. An entry farther in front than `own`, and than the exit lies behind, belongs to a solid in front.
SolidOnRay solid_in_layers(ivec2 texel, LitPoint point, float width, float tan_theta) {
    SolidOnRay solid = SolidOnRay(0.0, vec3(0.0), false, false);
    Tally outer = Tally(0.0, vec3(0.0), 0.0, vec3(0.0)), above = outer;
    uint entered = 0u;
    bool ended = false;
    for (uint layer = 0u; layer < layer_count; ++layer) {
        uint word = imageLoad(layer_triangle, ivec3(texel, layer)).r;
        uint triangle = triangle_index(word);
        ended = true;
        if (word == PELLUCID_NO_TRIANGLE || triangle == point.triangle) break;
        uint object = kOneObject ? point.object : find_object(triangle);
        Crossing crossed = crossing(triangle, object, point);
        float at = crossed.at;
        if (at >= 0.0) {
            float own = 1.41421356 * width * (1.0 + max(tan_theta, crossed.tan_theta));
            if (back_face(word) && !point.leaving && entered == 1u && -outer.entry > max(at, own)) {
                close_solid(outer, 0.0);
                entered = 0u;
            }
            break;
        }
        ended = false;
        MaterialRecord material = materials[objects[object].material];
        if (material.translucent == 0u) {
            solid.shadowed = true;
            return solid;
        }
        if (!back_face(word)) {
            ++entered;
            if (entered == 1u) {
                outer.entry = at, outer.sigma = material.sigma_a.rgb;
                above.thickness = 0.0, above.optical_depth = vec3(0.0);
            }
            if (entered == 2u) above.entry = at, above.sigma = material.sigma_a.rgb;
        } else if (entered > 0u) {
            if (entered == 2u) close_solid(above, at);
            if (entered == 1u) close_solid(outer, at);
            --entered;
        }
    }
    solid.cut = !ended;
    uint without_exit = entered - (point.leaving && entered > 0u ? 1u : 0u);
    if (point.leaving && entered == 1u) close_solid(outer, 0.0);
    if (point.leaving && entered == 2u) close_solid(above, 0.0);
    solid.thickness = outer.thickness + (without_exit > 0u ? above.thickness : 0.0);
    solid.optical_depth = outer.optical_depth + (without_exit > 0u ? above.optical_depth : vec3(0.0));
    return solid;
}

// Thickness behind the first surface, as in translucent shadow maps, where everything behind it is solid. On the lit
// side that surface is the point's own, or meets it within a texel's diagonal of `width` metres. Over the diagonal, a
// plane of slope tan(theta) to the map rises by sqrt(2) width tan(theta). Surfaces nearer than the steeper of the two
// rises count as the point's own.
SolidOnRay solid_behind_first(ivec2 texel, LitPoint point, float width, float tan_theta) {
    SolidOnRay solid = SolidOnRay(0.0, vec3(0.0), false, false);
    uint word = imageLoad(layer_triangle, ivec3(texel, 0)).r;
    uint triangle = triangle_index(word);
    if (word == PELLUCID_NO_TRIANGLE || triangle == point.triangle) return solid;
    uint object = kOneObject ? point.object : find_object(triangle);
    Crossing first = crossing(triangle, object, point);
    float inside = -first.at, own = 1.41421356 * width * (1.0 + max(tan_theta, first.tan_theta));
    if (inside <= (point.leaving ? 0.0 : own)) return solid;
    MaterialRecord material = materials[objects[object].material];
    solid.shadowed = material.translucent == 0u;
    solid.thickness = inside;
    solid.optical_depth = inside * material.sigma_a.rgb;
    return solid;
}

#endif
