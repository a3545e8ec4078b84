#ifndef PELLUCID_SHADE_EXACT_DEPTH_GLSL
#define PELLUCID_SHADE_EXACT_DEPTH_GLSL

// Depths of fragments of surface.vert, more exact than the rasteriser's. Needs: surface_fragment.glsl.
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "gpu/vertices.glsl"
#include "layers/objects.glsl"

const float kDepthRounding = 4e-6;  // relative rounding of a depth

// Depth of the triangle along the view ray, and whether its back is visible. The rasteriser's interpolated depth is
// too coarse to order glass that lies just in front.
float exact_depth(uint object, out bool behind) {
    ObjectRecord o = objects[object];
    uint corner = o.first_corner + 3u * (triangle - o.first_triangle);
    vec3 v[3];
    for (uint k = 0u; k < 3u; ++k)
        v[k] = (frame.view_from_world * (o.world_from_object * vec4(vertex_position(indices[corner + k]), 1.0))).xyz;
    vec3 normal = cross(v[1] - v[0], v[2] - v[0]);
    Ray ray = camera_ray(gl_FragCoord.xy);
    float along = dot(normal, ray.direction);
    behind = (along > 0.0) != (o.mirrored != 0u);
    float depth = -(ray.origin + dot(normal, v[0] - ray.origin) / along * ray.direction).z;
    vec3 depths = -vec3(v[0].z, v[1].z, v[2].z);
    float low = min(depths.x, min(depths.y, depths.z)), high = max(depths.x, max(depths.y, depths.z));
    return depth >= low && depth <= high ? depth : clamp(eye_depth(), low, high);  // edge-on, the depth is undefined
}

#endif
