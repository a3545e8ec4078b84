#ifndef PELLUCID_VOLUME_LIGHT_PLANE_GLSL
#define PELLUCID_VOLUME_LIGHT_PLANE_GLSL

// Planar objects that catch light. Needs: volume/light_records.h; buffer Receivers { LightReceiver receivers[]; }.

// Where a ray meets the rectangle of a receiver: place in texels, and the distance along `direction` (any length);
// 1e30 if it does not.
float receiver_distance(LightReceiver receiver, vec3 position, vec3 direction, out vec2 texel) {
    float toward = dot(direction, receiver.normal.xyz);
    vec3 from_corner = position - receiver.corner.xyz;
    float t = abs(toward) > 1e-9 ? -dot(from_corner, receiver.normal.xyz) / toward : 1e30;
    vec3 at = from_corner + t * direction;
    texel = vec2(dot(at, receiver.side.xyz), dot(at, receiver.up.xyz)) / receiver.corner.w;
    bool inside = texel.x >= 0.0 && texel.y >= 0.0 && texel.x <= receiver.side.w && texel.y <= receiver.up.w;
    return inside && t < 1e30 ? t : 1e30;
}

#endif
