#version 460
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec4 radiance;

void main() {
    bool floor_tile = (int(floor(2.0 * at.x + 100.0)) + int(floor(2.0 * at.z + 100.0))) % 2 == 0;
    vec3 color = at.y > -0.99 ? vec3(0.7, 0.15, 0.1) : floor_tile ? vec3(0.6) : vec3(0.08, 0.12, 0.2);
    radiance = vec4(color * (0.4 + 0.6 * max(dot(normalize(normal), normalize(vec3(1.0, 2.0, 1.5))), 0.0)), 1.0);
}
