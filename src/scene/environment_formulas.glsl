#ifndef PELLUCID_SCENE_ENVIRONMENT_FORMULAS_GLSL
#define PELLUCID_SCENE_ENVIRONMENT_FORMULAS_GLSL

// The procedural environments, in the common subset of GLSL and C++ with GLM. Shaders include this file through
// gpu/environment.glsl, the CPU through scene/environment.cpp, so both evaluate the same light. C++ needs the `f`
// after every number.
//
// `d` is a unit direction pointing away from the scene, +Y up; the default camera looks along -Z.

// Numbers of Environment::Kind.
const uint kEnvironmentMap = 0u;
const uint kEnvironmentStudio = 1u;
const uint kEnvironmentChecker = 2u;
const uint kEnvironmentSky = 3u;
const uint kEnvironmentUniform = 4u;

const float kEnvironmentPi = 3.14159265f;

// Equirectangular coordinates: u from longitude, v from the top. +X is the centre, -Z is u = 1/4.
vec2 equirect_from_direction(vec3 d) {
    // The poles have no longitude, and atan(0, 0) is undefined in GLSL.
    float longitude = d.x == 0.0f && d.z == 0.0f ? 0.0f : atan(d.z, d.x);
    return vec2(0.5f + longitude / (2.0f * kEnvironmentPi),
                acos(clamp(d.y, -1.0f, 1.0f)) / kEnvironmentPi);
}

// 1 for |x| <= half_size, 0 beyond half_size + softness.
float soft_band(float x, float half_size, float softness) {
    return 1.0f - smoothstep(half_size, half_size + softness, abs(x));
}

// A rectangular lamp in the plane at distance 1 along `axis` (horizontal or vertical), in coordinates of that plane.
// It is brightest in the middle, like cloth in front of a bulb.
float soft_lamp(vec3 d, vec3 axis, vec3 across, vec3 along, vec2 centre, vec2 half_size,
                float softness) {
    float facing = dot(d, axis);
    if (facing <= 0.001f) return 0.0f;
    vec2 p = vec2(dot(d, across), dot(d, along)) / facing - centre;
    float edges = soft_band(p.x, half_size.x, softness) * soft_band(p.y, half_size.y, softness);
    vec2 from_middle = p / (half_size + softness);
    return edges * (1.0f - 0.4f * min(dot(from_middle, from_middle), 1.0f));
}

// A product photographer's dark studio: a soft box overhead, a tall narrow cool strip light behind on the right and a
// wide warm one on the left. The asymmetry reveals mirrored images.
vec3 studio_radiance(vec3 d) {
    float wall = smoothstep(-0.35f, 0.9f, d.y);
    vec3 room = mix(vec3(0.11f, 0.11f, 0.12f), vec3(0.05f, 0.05f, 0.06f), wall);
    // The table top ends in a soft horizon below eye level, which reveals inverted images in glass.
    float table = 1.0f - smoothstep(-0.30f, -0.20f, d.y);
    room = mix(room, vec3(0.23f, 0.21f, 0.19f) * (1.0f + 0.7f * d.y), table);
    // A lit patch of backdrop behind the object, cut off by the table. The walls around it are dark, which gives the
    // glass an outline.
    float glow = max(dot(d, vec3(0.0f, 0.0995f, -0.9950f)), 0.0f);
    room += vec3(0.27f, 0.30f, 0.34f) * pow(glow, 12.0f) * (1.0f - 0.75f * table);

    const vec3 up = vec3(0.0f, 1.0f, 0.0f);
    float box = soft_lamp(d, up, vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f),
                          vec2(0.0f, -0.10f), vec2(0.50f, 0.34f), 0.10f);
    float right = soft_lamp(d, vec3(0.8660f, 0.0f, -0.5f), vec3(0.5f, 0.0f, 0.8660f), up,
                            vec2(0.0f, 0.25f), vec2(0.11f, 0.62f), 0.05f);
    float left = soft_lamp(d, vec3(-0.9063f, 0.0f, -0.4226f), vec3(0.4226f, 0.0f, -0.9063f), up,
                           vec2(0.0f, 0.20f), vec2(0.32f, 0.48f), 0.10f);
    // A weak card beside the camera lights the front of the object.
    float fill = soft_lamp(d, vec3(0.5f, 0.0f, 0.8660f), vec3(0.8660f, 0.0f, -0.5f), up,
                           vec2(0.0f, 0.30f), vec2(0.30f, 0.30f), 0.35f);
    return room + vec3(5.6f, 5.5f, 5.4f) * box + vec3(7.0f, 7.5f, 8.0f) * right +
           vec3(3.6f, 2.9f, 2.2f) * left + vec3(0.7f, 0.7f, 0.7f) * fill;
}

// 24 x 12 cells of 15 degrees. The hue identifies the quarter of longitude (red, yellow, green, blue from u = 0); the
// upper half is lighter than the lower.
vec3 checker_radiance(vec3 d) {
    vec2 uv = equirect_from_direction(d);
    uint column = uint(floor(uv.x * 24.0f)) % 24u;
    uint row = min(uint(floor(uv.y * 12.0f)), 11u);
    uint quarter = column / 6u;
    vec3 hue = vec3(1.0f, 0.25f, 0.18f);
    if (quarter == 1u) hue = vec3(1.0f, 0.80f, 0.15f);
    if (quarter == 2u) hue = vec3(0.22f, 0.80f, 0.30f);
    if (quarter == 3u) hue = vec3(0.20f, 0.42f, 1.0f);
    bool upper = row < 6u;
    bool light = (column + row) % 2u == 0u;
    if (light) return upper ? mix(hue, vec3(1.0f), 0.35f) : hue * 0.60f + 0.02f;
    return upper ? hue * 0.25f + 0.05f : hue * 0.05f + 0.05f;
}

// Clear sky: paler and brighter towards the horizon and around the sun.
vec3 sky_dome_radiance(vec3 d, vec3 sun, vec3 horizon) {
    float height = 1.0f - exp(-5.0f * d.y);
    vec3 blue = mix(horizon, vec3(0.10f, 0.26f, 0.66f), height);
    float toward_sun = max(dot(d, sun), 0.0f);
    blue += vec3(0.30f, 0.26f, 0.20f) * pow(toward_sun, 12.0f);
    blue += vec3(1.60f, 1.40f, 1.10f) * pow(toward_sun, 400.0f);
    // The disc, 1.25 degrees in radius. Near the sun the chord approximates the angle, and is exact where acos is not.
    float angle = length(d - sun);
    return blue + vec3(200.0f, 188.0f, 165.0f) * (1.0f - smoothstep(0.0174f, 0.0262f, angle));
}

// A tiled plane 1.5 m below the eye, fading into the haze of the horizon.
vec3 sky_ground_radiance(vec3 d, vec3 horizon) {
    float metres = 1.5f / max(-d.y, 0.0001f);
    vec2 p = vec2(d.x, d.z) * metres;
    // Alternating one-metre tiles, with every fourth line in X and Z coloured: they reveal refraction, and tell X from
    // Z. The eye is above a tile's centre.
    p += 2.5f;
    vec2 tile = floor(p);
    float parity = tile.x + tile.y - 2.0f * floor((tile.x + tile.y) * 0.5f);
    vec3 colour = parity < 0.5f ? vec3(0.36f, 0.34f, 0.30f) : vec3(0.09f, 0.10f, 0.11f);
    vec2 to_line = abs(p - 4.0f * floor(p / 4.0f + 0.5f));
    if (to_line.x < 0.06f) colour = vec3(0.60f, 0.10f, 0.06f);
    if (to_line.y < 0.06f) colour = vec3(0.06f, 0.16f, 0.55f);
    return mix(horizon, colour, exp(-metres / 14.0f));
}

// Outdoors, with the sun at 42 degrees of elevation behind the object on the right.
vec3 sky_radiance(vec3 d) {
    const vec3 sun = vec3(0.5255f, 0.6691f, -0.5255f);
    const vec3 horizon = vec3(0.68f, 0.78f, 0.90f);
    return d.y >= 0.0f ? sky_dome_radiance(d, sun, horizon) : sky_ground_radiance(d, horizon);
}

// Radiance of environment `kind` from direction d; 0 for kEnvironmentMap.
vec3 procedural_radiance(uint kind, vec3 uniform_radiance, vec3 d) {
    if (kind == kEnvironmentStudio) return studio_radiance(d);
    if (kind == kEnvironmentChecker) return checker_radiance(d);
    if (kind == kEnvironmentSky) return sky_radiance(d);
    if (kind == kEnvironmentUniform) return uniform_radiance;
    return vec3(0.0f);
}

#endif
