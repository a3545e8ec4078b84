#version 460
// Copies every record that the rasteriser has found to the list of its texel.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"
layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
#include "layers/surface_map.glsl"
#include "layers/objects.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 3) readonly buffer Traits { uint traits[]; };  // per object
layout(set = 0, binding = 6) uniform utextureBuffer texels;
layout(set = 0, binding = 7) uniform utextureBuffer found;
layout(std430, set = 0, binding = 8) writeonly buffer Ranges { uint ranges[]; };
layout(std430, set = 0, binding = 9) writeonly buffer Records { SurfaceRecord records[]; };
layout(std430, set = 0, binding = 10) readonly buffer ShellTraits { uint shell_traits[]; };  // per triangle of meshes
layout(constant_id = 0) const bool kOneObject = false;
// The map of a mesh. Its records belong to no object, and the walk adds the traits of the object.
layout(constant_id = 1) const bool kOfMesh = false;
layout(constant_id = 2) const bool kManySlots = false;  // shells of one mesh differ
layout(push_constant) uniform Push { uint end; };  // of the map's records

void main() {
    uint group = gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y;
    uint i = group * 64u + gl_LocalInvocationID.x;
    if (i >= min(texelFetch(found, 0).x, uint(textureSize(found)) - 1u)) return;
    uvec4 record = texelFetch(found, int(i) + 1);  // texel, number there, triangle, range
    if (record.x == kNoTexel) return;
    uint object = kOneObject ? 0u : find_object(record.z);
    uint place = texelFetch(texels, int(record.x)).x + record.y;
    if (place >= end) return;
    ranges[place] = record.w;
    uint own = kOfMesh ? 0u : traits[object];
    if (kManySlots) {
        ObjectRecord o = objects[object];
        own += shell_traits[kOfMesh ? record.z : record.z - o.first_triangle + o.first_corner / 3u];
    }
    records[place] = SurfaceRecord(record.z, own);
}
