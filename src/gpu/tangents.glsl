#ifndef PELLUCID_GPU_TANGENTS_GLSL
#define PELLUCID_GPU_TANGENTS_GLSL

// Normals that textures tilt: glTF 2.0, section 3.9.3. Needs: tangents (uint[], packed_tangents() of material_records.h),
// gpu/appearance.glsl, gpu/texture.glsl, Objects.
#include "gpu/octahedral.glsl"

// A point of a triangle.
struct TexturedPoint {
    uvec3 v;              // the corners' vertices
    vec3 weights;         // of the corners
    vec3 edge_b, edge_c;  // from the first corner, world, m
    vec4 texcoords;       // both sets
};

vec2 corner_texcoord(uint vertex, bool second_set) {
    vec4 both = vertex_texcoords(vertex);
    return second_set ? both.zw : both.xy;
}

// The direction in which u grows, of any length, and w of Mesh::tangents; w = 0: unknown.
vec4 tangent_at(TexturedPoint point, ObjectRecord object, vec3 normal, bool second_set) {
    uvec3 packed = uvec3(0u);
    if (all(lessThan(point.v, uvec3(tangents.length())))) packed = uvec3(tangents[point.v.x], tangents[point.v.y], tangents[point.v.z]);
    if (all(notEqual(packed, uvec3(0u))) && (packed.x & 1u) == (packed.y & 1u) && (packed.x & 1u) == (packed.z & 1u)) {
        vec3 along = point.weights.x * unpack_unit_vector(packed.x) + point.weights.y * unpack_unit_vector(packed.y) +
                     point.weights.z * unpack_unit_vector(packed.z);
        // A mirror turns the frame around.
        return vec4(mat3(object.world_from_object) * along, ((packed.x & 1u) != 0u) != (object.mirrored != 0u) ? 1.0 : -1.0);
    }
    vec2 a = corner_texcoord(point.v.x, second_set);
    vec2 b = corner_texcoord(point.v.y, second_set) - a, c = corner_texcoord(point.v.z, second_set) - a;
    float area = b.x * c.y - b.y * c.x;
    if (area == 0.0) return vec4(0.0);
    vec3 along = (point.edge_b * c.y - point.edge_c * b.y) / area, up = (point.edge_b * c.x - point.edge_c * b.x) / area;
    return vec4(along, dot(cross(normal, along), up) < 0.0 ? -1.0 : 1.0);
}

// Columns: the directions of u and -v in the surface, and its outward unit normal. `known`: texture coordinates say them.
mat3 texture_frame(TexturedPoint point, ObjectRecord object, vec3 normal, bool second_set, out bool known) {
    vec4 tangent = tangent_at(point, object, normal, second_set);
    vec3 along = tangent.xyz - normal * dot(normal, tangent.xyz);
    float squared = dot(along, along);
    known = tangent.w != 0.0 && squared > 0.0 && squared < 1e30;
    if (!known) return mat3(1.0);
    along *= inversesqrt(squared);
    return mat3(along, tangent.w * cross(normal, along), normal);
}

const float kLeastCosine = 0.01;  // to the triangle's normal

// -1..1. Of 8 bits 128 stands for 0, so that a flat texture is flat.
vec3 signed_channels(vec3 stored) { return clamp((255.0 * stored - 128.0) / 127.0, -1.0, 1.0); }

// `outward`, tilted by a texture. Where that is flat, `outward` itself.
vec3 tilted_normal(TexturedPoint point, ObjectRecord object, vec3 outward, uint texture_index, float scale) {
    if (texture_index == PELLUCID_NO_TEXTURE) return outward;
    vec3 direction = signed_channels(sample_texture(texture_index, point.texcoords.xy, point.texcoords.zw).xyz);
    direction.xy *= scale;
    if (max(abs(direction.x), abs(direction.y)) < 1e-4) return outward;
    bool known, second_set = (textures[texture_index].flags & PELLUCID_TEXTURE_SECOND_SET) != 0u;
    mat3 frame_ = texture_frame(point, object, outward, second_set, known);
    if (!known) return outward;
    return normalize(frame_ * vec3(direction.xy, max(direction.z, kLeastCosine)));
}

// A tilted normal on the viewer's side, bent as little as the mirrored view direction needs to stay above the triangle. Twin
// of surface_frame.h.
vec3 mirroring_above(vec3 normal, TexturedPoint point, vec3 to_viewer) {
    vec3 flat_ = normalize(cross(point.edge_b, point.edge_c));
    if (dot(flat_, to_viewer) < 0.0) flat_ = -flat_;
    vec3 mirrored = 2.0 * dot(normal, to_viewer) * normal - to_viewer;
    float height = dot(mirrored, flat_);
    if (height >= kLeastCosine) return normal;
    return normalize(to_viewer + normalize(mirrored + (kLeastCosine - height) * flat_));
}

// Unit, on the viewer's side: `outward` (unit, interpolated) with a texture over it. `side`: -1 where the viewer sees the back.
vec3 seen_normal(TexturedPoint point, ObjectRecord object, vec3 outward, float side, uint texture_index, float scale, vec3 to_viewer) {
    vec3 tilted = tilted_normal(point, object, outward, texture_index, scale);
    return tilted != outward ? mirroring_above(side * tilted, point, to_viewer) : side * outward;
}

#endif
