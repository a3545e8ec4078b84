#version 460
// Adds the light of one light source that translucent surfaces scatter. The light arrives through the solids along its
// ray, I0 exp(-c d), on either side (KHR_materials_diffuse_transmission, KHR_materials_volume). With kMeasures, writes
// d instead.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = 3) readonly buffer LightFrame { FrameConstants light_view; };
layout(set = 0, binding = 4, r32ui) readonly uniform uimage2DArray surface_triangle;
layout(set = 0, binding = 5, r32ui) readonly uniform uimage2DArray surface_normals;
layout(set = 0, binding = 6, rgba16f) readonly uniform image2DArray surface_reflected;
layout(set = 0, binding = 7, rgba16f) readonly uniform image2DArray surface_transmitted;
layout(set = 0, binding = 8, r32ui) readonly uniform uimage2DArray layer_triangle;
layout(std430, set = 0, binding = 9) readonly buffer LocalThickness { float local_thickness[]; };
// first value; bits of the scale
layout(std430, set = 0, binding = 10) readonly buffer LocalObjects { uvec2 local_objects[]; };
layout(set = 0, binding = 11, rgba32f) uniform image2DArray radiance;
layout(set = 0, binding = 12, r32f) writeonly uniform image2DArray thickness;
layout(std430, set = 0, binding = 13) buffer LightCounters { uint cut_rays; };
#include "gpu/vertices.glsl"
#include "gpu/octahedral.glsl"
#include "layers/layers.glsl"
#include "layers/objects.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_normal.glsl"
#include "gpu/light_parts.glsl"
#include "gpu/punctual_light.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(constant_id = 0) const uint kMethod = 0u;  // kByLayers, kByFirst, kLocal or kStored
const uint kByLayers = 0u, kByFirst = 1u, kLocal = 2u, kStored = 3u;
layout(constant_id = 1) const bool kMeasures = false;  // write d, add no light
layout(constant_id = 2) const bool kOneObject = false;
layout(push_constant) uniform Push {
    PunctualLight light;
    uint face;  // face of a cube around the light: +x, -x, +y, -y, +z, -z; 6: the light's only view
    uint layer_count;
};
#include "shade/solid_on_ray.glsl"
#include "shade/stored_depths.glsl"

const float kPi = 3.14159265;
const uint kWholeView = 6u;

uint cube_face(vec3 direction) {
    vec3 size = abs(direction);
    if (size.x >= size.y && size.x >= size.z) return direction.x > 0.0 ? 0u : 1u;
    if (size.y >= size.z) return direction.y > 0.0 ? 2u : 3u;
    return direction.z > 0.0 ? 4u : 5u;
}

float baked_thickness(SurfacePoint at, uint object) {
    uvec3 value = local_objects[object].x + at.corners;
    vec3 baked = vec3(local_thickness[value.x], local_thickness[value.y], local_thickness[value.z]);
    return uintBitsToFloat(local_objects[object].y) * dot(at.weights, baked);
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;
    ivec3 pixel = ivec3(texel, 0);
    uint triangle = imageLoad(surface_triangle, pixel).r, object = find_object(triangle);
    SurfacePoint at = surface_point(object_ray(vec2(texel) + 0.5, object), triangle, object);
    vec3 a = vertex_position(at.corners.x), b = vertex_position(at.corners.y), c = vertex_position(at.corners.z);
    LitPoint point;
    point.in_mesh = a + at.weights.y * (b - a) + at.weights.z * (c - a);
    point.world = (objects[object].world_from_object * vec4(point.in_mesh, 1.0)).xyz;
    if (face != kWholeView && cube_face(point.world - light.position) != face) return;
    ArrivingLight arriving = arriving_light(light, point.world);
    if (!(arriving.irradiance > 0.0)) return;
    point.way = arriving.way;
    point.object = object;
    point.triangle = triangle;
    mat3 object_from_world = transpose(mat3(objects[object].world_from_object_normal));
    point.way_in_mesh = object_from_world * point.way;
    vec3 outward = cross(b - a, c - a) * (objects[object].mirrored != 0u ? -1.0 : 1.0);
    point.leaving = dot(outward, point.way_in_mesh) > 0.0;

    float d = 0.0, shadowed = 0.0;
    vec3 transmittance = vec3(1.0);
    bool cut = false;
    if (kMethod == kLocal) {
        d = point.leaving ? baked_thickness(at, object) : 0.0;
        transmittance = exp(-d * materials[objects[object].material].sigma_a.rgb);
    } else {
        vec3 in_view = (light_view.view_from_world * vec4(point.world, 1.0)).xyz;
        vec2 film = light_view.orthographic != 0u ? in_view.xy : in_view.xy / -in_view.z;
        vec2 map = vec2(film.x - light_view.film.x, light_view.film.y - film.y) / light_view.film.zw - 0.5;
        ivec2 first = ivec2(floor(map)), last = ivec2(light_view.width, light_view.height) - 1;
        vec2 f = kMethod == kStored ? round(map - vec2(first)) : map - vec2(first);
        float width = max(light_view.film.z, light_view.film.w) * (light_view.orthographic != 0u ? 1.0 : -in_view.z);
        float cos_theta = abs(dot(normalize(mat3(objects[object].world_from_object_normal) * outward), point.way));
        float tan_theta = sqrt(max(1.0 - cos_theta * cos_theta, 0.0)) / max(cos_theta, 1e-6);
        // Interpolate between four texels, so that edges of occluders are one texel wide instead of stepped. Where the
        // light leaves a solid, ignore texels beside that solid's silhouette.
        float known = 0.0;
        transmittance = vec3(0.0);
        for (int i = 0; i < 4; ++i) {
            ivec2 corner = ivec2(i & 1, i >> 1);
            float weight = (corner.x == 1 ? f.x : 1.0 - f.x) * (corner.y == 1 ? f.y : 1.0 - f.y);
            if (weight == 0.0) continue;
            ivec2 read = clamp(first + corner, ivec2(0), last);
            SolidOnRay solid;
            if (kMethod == kStored) solid = solid_in_stored_depths(read, in_view);
            else if (kMethod == kByFirst) solid = solid_behind_first(read, point, width, tan_theta);
            else solid = solid_in_layers(read, point, width, tan_theta);
            cut = cut || solid.cut;
            if (kMethod != kStored && point.leaving && solid.thickness == 0.0 && !solid.shadowed) continue;
            known += weight;
            d += weight * solid.thickness;
            shadowed += solid.shadowed ? weight : 0.0;
            transmittance += solid.shadowed ? vec3(0.0) : weight * exp(-solid.optical_depth);
        }
        d = known > 0.0 ? d / known : 0.0;
        shadowed = known > 0.0 ? shadowed / known : 0.0;
        transmittance = known > 0.0 ? transmittance / known : vec3(1.0);
    }
    if (cut) atomicAdd(cut_rays, 1u);
    if (kMeasures) {
        imageStore(thickness, pixel, vec4(shadowed > 0.5 ? -2.0 : d));  // kShadowed
        return;
    }
    vec3 normal = unpack_unit_vector(imageLoad(surface_normals, pixel).r);
    float cos_theta = -dot(normal, point.way);  // cosine to the light, on the viewer's side
    vec3 scattered = cos_theta > 0.0 ? imageLoad(surface_reflected, pixel).rgb : imageLoad(surface_transmitted, pixel).rgb;
    vec3 added = scattered * (abs(cos_theta) / kPi * arriving.irradiance) * light.intensity * transmittance;
    vec4 before = imageLoad(radiance, pixel);
    imageStore(radiance, pixel, vec4(before.rgb + drawn(PELLUCID_DIRECT, added), before.a));
}
