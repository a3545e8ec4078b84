#version 460
// Wyman, "An Approximate Image-Space Approach for Interactive Refraction", SIGGRAPH 2005: two interfaces. The length
// of the refracted ray is estimated from two known distances. The second normal is then read from an image of the back
// faces. Section numbers are the paper's.
#extension GL_GOOGLE_include_directive : require
#include "techniques/technique_bindings.glsl"

#include "gpu/vertices.glsl"
#include "layers/pixel_list.glsl"
#include "layers/surface_normal.glsl"
#include "techniques/wyman_2005/baked_distances.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

layout(constant_id = 0) const bool kSampled = false;    // use the table of distances instead of d_N
layout(constant_id = 1) const bool kAlongView = false;  // use d_V alone
layout(constant_id = 2) const uint kInnerReflections = 0u;

layout(set = 0, binding = 10, r32f) readonly uniform image2DArray back_depth;
layout(set = 0, binding = 11, r32ui) readonly uniform uimage2DArray back_normal;
layout(push_constant) uniform Push {
    uint table_side;
    uint linear_steps;  // for the wall after an inner reflection
    uint binary_steps;
};

const float kSmallAngle = 1e-3;  // radians; below, the ratio of angles differs from its limit by less than 1e-6

bool within_picture(ivec2 texel) {
    return all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(frame.width, frame.height)));
}

float back_depth_at(ivec2 texel) { return imageLoad(back_depth, ivec3(texel, 0)).r; }

// Ratio theta_t / theta_i at the entry.
float angle_ratio(vec3 incident, vec3 normal, float eta) {
    float sin_i = min(length(cross(incident, normal)), 1.0);
    return sin_i < kSmallAngle ? eta : asin(min(eta * sin_i, 1.0)) / asin(sin_i);
}

// Distance d from the entry to the exit (3.1); negative: unknown.
float guess_distance(Path path, vec2 pixel, Fragment first, vec3 incident, vec3 normal, float eta) {
    uint object = find_object(triangle_index(first.triangle));
    if (kSampled) {
        vec3 position = (frame.world_from_view * vec4(path.position, 1.0)).xyz;
        vec3 direction = mat3(frame.world_from_view) * path.direction;
        return sampled_distance(object, position, direction, table_side);
    }
    float depth = back_depth_at(ivec2(pixel));
    if (depth == PELLUCID_EMPTY_DEPTH) return -1.0;
    float along_view = distance(path.position, view_position(pixel, max(depth, first.depth)));
    if (kAlongView) return along_view;
    SurfacePoint entry = surface_point(object_ray(pixel, object), first.triangle, object);
    return mix(inward_distance(entry, object), along_view, angle_ratio(incident, normal, eta));
}

// Depth of the back faces, or of the first surface.
float wall_depth(ivec2 texel, bool front) {
    return front ? imageLoad(layer_depth, ivec3(texel, 0)).r : back_depth_at(texel);
}
vec3 wall_normal(ivec2 texel, bool front) {
    uint packed = front ? imageLoad(layer_normal, ivec3(texel, 0)).r : imageLoad(back_normal, ivec3(texel, 0)).r;
    return unpack_unit_vector(packed);
}

// Outward normal of the wall at a point's projection (3.2), interpolated between four texels. Returns false if the
// projection lies beside the wall.
bool exit_normal(vec3 position, bool front, out vec3 normal) {
    vec2 pixel = project(position);
    ivec2 texel = ivec2(floor(pixel));
    if (!within_picture(texel) || wall_depth(texel, front) == PELLUCID_EMPTY_DEPTH) return false;
    ivec2 low = ivec2(floor(pixel - 0.5));
    vec2 share = pixel - 0.5 - vec2(low);
    vec3 nearest = wall_normal(texel, front);
    normal = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        if (!within_picture(low + step) || wall_depth(low + step, front) == PELLUCID_EMPTY_DEPTH) continue;
        vec2 weights = mix(1.0 - share, share, vec2(step));
        normal += weights.x * weights.y * wall_normal(low + step, front);
    }
    // If opposite normals cancel out, use the nearest texel's normal.
    normal = mat3(frame.view_from_world) * (dot(normal, normal) > 1e-12 ? normalize(normal) : nearest);
    return true;
}

// Leaves the solid. The angle of incidence is limited to the critical angle (3.3): a totally reflected ray leaves
// along the surface instead, with all its light.
void leave(inout Path path, vec3 normal, float ior) {
    vec3 incident = path.direction;
    if (cross_interface(path, normal, true, ior)) return;
    --path.reflections;
    if (path.status == kStatusOk) path.status = kStatusEventLimit;
    vec3 along = incident - dot(incident, normal) * normal;
    path.direction = dot(along, along) > 1e-12 ? normalize(along) : incident;
}

// Normal for rays beside the object: at its edge, normals are perpendicular to the view ray (3.3).
vec3 edge_normal(vec3 direction, vec3 view_direction) {
    vec3 across = direction - dot(direction, view_direction) * view_direction;
    return dot(across, across) > 1e-12 ? normalize(across) : direction;
}

#include "techniques/wyman_2005/inner_reflections.glsl"

// Crosses the second interface.
void cross_second(inout Path path, vec3 view_direction, MaterialRecord material) {
    if (-path.position.z <= 0.0 && frame.orthographic == 0u) {  // behind the eye
        path.status = kStatusLeftScreen;
        return;
    }
    vec3 exit;
    if (!exit_normal(path.position, false, exit)) {
        bool seen = within_picture(ivec2(floor(project(path.position))));
        path.status = seen ? kStatusMissingLayer : kStatusLeftScreen;
        exit = edge_normal(path.direction, view_direction);
    } else if (kInnerReflections > 0u && bounce(path, view_direction, exit, material)) {
        return;
    }
    leave(path, exit, material.ior);
}

void main() {
    ivec2 texel;
    if (!listed_pixel(texel)) return;

    vec2 pixel = vec2(texel) + 0.5;
    Path path = camera_path(pixel);
    vec3 view_direction = path.direction;
    Fragment first = load_fragment(texel, 0u);
    MaterialRecord material = material_of(first);
    vec3 position = view_position(pixel, first.depth);
    vec3 normal = view_normal(texel, 0u);
    bool inside = back_face(first.triangle);
    if (inside) {  // the interface before this one is missing
        travel(path, distance(path.position, position), material.sigma_a.rgb);
        path.status = kStatusMissingLayer;
    }
    path.position = position;
    cross_interface(path, normal, inside, material.ior);
    float first_transmittance = path.transmittance.r;
    if (!inside) {
        float d = guess_distance(path, pixel, first, view_direction, normal, 1.0 / material.ior);
        if (d < 0.0) {
            path.status = kStatusMissingLayer;
        } else {
            travel(path, d, material.sigma_a.rgb);
            cross_second(path, view_direction, material);
        }
    }
    store_refraction(texel, path);
    // For nearby_geometry.comp: alpha is the transmittance after the first interface.
    imageStore(transmittance, ivec3(texel, 0), vec4(path.transmittance, first_transmittance));
}
