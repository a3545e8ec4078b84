#ifndef PELLUCID_VOLUME_LIGHT_KEY_GLSL
#define PELLUCID_VOLUME_LIGHT_KEY_GLSL

// The brightest light of a voxel, in 64 bits that grow with its brightness. From the top:
// - 24 bits of brightness: the sum of the colours, a float without its sign and last 7 bits (1 in 2^16).
// - 24 bits of direction: octahedral, 2 x 12 bits, within 0.06 degrees.
// - 16 bits: shares of red and green.
// Needs: gpu/octahedral.glsl; 64-bit integers.

uint64_t light_key(vec3 irradiance, vec3 way) {
    float sum = irradiance.r + irradiance.g + irradiance.b;
    vec2 share = irradiance.rg / max(sum, 1e-30);
    uvec2 place = uvec2(clamp(octahedral_from_direction(way) * 0.5 + 0.5, 0.0, 1.0) * 4095.0 + 0.5);
    uvec2 chroma = uvec2(clamp(share, 0.0, 1.0) * 255.0 + 0.5);
    uint payload_low = chroma.x << 8 | chroma.y, direction = place.x << 12 | place.y;
    uint brightness = floatBitsToUint(sum) >> 7;
    return uint64_t(brightness) << 40 | uint64_t(direction) << 16 | uint64_t(payload_low);
}

vec3 key_direction(uint64_t key) {
    uint direction = uint(key >> 16) & 0xffffffu;
    return normalize(octahedron_point(vec2(direction >> 12, direction & 0xfffu) / 4095.0 * 2.0 - 1.0));
}

vec3 key_irradiance(uint64_t key) {
    float sum = uintBitsToFloat(uint(key >> 40) << 7 | 0x40u);
    vec2 share = vec2(uint(key >> 8) & 0xffu, uint(key) & 0xffu) / 255.0;
    vec3 shares = vec3(share, max(1.0 - share.x - share.y, 0.0));
    return key == 0ul ? vec3(0.0) : sum * shares / (shares.r + shares.g + shares.b);
}

#endif
