#ifndef PELLUCID_SHADE_SOLID_ON_RAY_GLSL
#define PELLUCID_SHADE_SOLID_ON_RAY_GLSL

// How much solid lies on a ray of light before the point that it arrives at (Chen, translucency by measured thickness).
//
// A texel of a light's map names the triangles that the ray through its centre crosses. The ray that arrives at the
// point passes beside that, by less than a texel: it is their planes that are crossed here by the ray itself, so that
// depths are those of the point's own ray and no texel has to be told from its neighbour by a bias. All distances are
// from the point, in metres along the light: what is in front of the point is negative.
// Needs: objects, materials, gpu/vertices.glsl, layers/layers.glsl, layers/objects.glsl, layer_triangle, layer_count,
// kOneObject.

// A visible point, and the light that arrives there.
struct LitPoint {
    vec3 world;
    vec3 way;           // unit, the way the light goes
    uint object;
    vec3 in_mesh;       // in the frame of the object's mesh
    vec3 way_in_mesh;
    uint triangle;      // that the point lies on
    bool leaving;       // the light leaves the solid there
};

struct SolidOnRay {
    float thickness;     // m
    vec3 optical_depth;  // the sum of c d
    bool shadowed;       // something opaque is in front
    bool cut;            // there are more surfaces in front than layers
};

// Where the light crosses the plane of a triangle.
struct Crossing {
    float at;         // m from the point
    float tan_theta;  // of the angle between the plane and one that faces the light
};

// Kept to once the triangle's own extent beyond it: seen edge-on, planes run far away.
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
    at = at == at ? clamp(at, low - extent, high + extent) : low;  // 0 / 0: in the plane
    return Crossing(at, length(cross(normal, way)) / max(abs(speed), 1e-30));
}

// Lengths of solid on the way, and the one that is open.
struct Tally {
    float thickness;
    vec3 optical_depth;
    float entry;  // of the open one
    vec3 sigma;
};
void close_solid(inout Tally tally, float at) {
    float inside = max(at - tally.entry, 0.0);
    tally.thickness += inside;
    tally.optical_depth += inside * tally.sigma;
}

// By the layers of a texel. The light is in a solid while it has entered more than it has left. Entries and exits that
// have no partner count nothing: those of open meshes, and those at silhouettes, where the texel's ray passes a solid
// that the point's does not. An exit without an entry is passed over. Of an entry without an exit it is only known at
// the end that it has none; `above` tallies the solids since the last time outside as if it were not there.
// A visible point is where its light leaves the last solid that it is in, or is outside.
//
// No bias tells the point's own surface from others. Met a little before the point, it has no partner where the light
// enters, and where it leaves the length is the same. Only on the lit side, in a crease, the exit of what is in front
// may come to lie behind the point by less than a texel: `own` is what the point's surface itself, or one that meets
// it, can be off by. An entry farther in front than that, and than the exit is behind, is that of a solid in front.
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

// By the first surface alone, as translucent shadow maps have it: whatever is behind it is solid. On the lit side that
// surface is the point's own, or runs into it within a diagonal of a texel of `width` metres, over which a plane of slope
// tan(theta) to the map rises by sqrt(2) width tan(theta). What is nearer than the steeper of the two rises is that.
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
