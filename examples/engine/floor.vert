#version 460
// A floor of four metres and four pillars: boxes generated from the vertex index.
layout(push_constant) uniform Push { mat4 clip_from_world; };
layout(location = 0) out vec3 at;
layout(location = 1) out vec3 normal;

void main() {
    const ivec3 kCorners[6] = {ivec3(0, 0, 1), ivec3(1, 0, 1), ivec3(1, 1, 1), ivec3(0, 0, 1), ivec3(1, 1, 1), ivec3(0, 1, 1)};
    int box = gl_VertexIndex / 36, side = gl_VertexIndex / 6 % 6;
    vec3 p = 2.0 * vec3(kCorners[gl_VertexIndex % 6]) - 1.0, n = vec3(0.0, 0.0, 1.0);
    if (side >= 3) p.z = -p.z, n.z = -n.z;
    for (int turn = 0; turn < side % 3; ++turn) p = p.zxy, n = n.zxy;
    vec3 size = box == 0 ? vec3(2.0, 0.05, 2.0) : vec3(0.12, 0.8, 0.12);
    vec3 middle = box == 0 ? vec3(0.0, -1.05, 0.0) : vec3(box % 2 == 0 ? 1.2 : -1.2, -0.2, box < 3 ? -1.2 : 1.2);
    at = middle + size * p;
    normal = n;
    gl_Position = clip_from_world * vec4(at, 1.0);
}
