#ifndef PELLUCID_GPU_TEXTURE_GLSL
#define PELLUCID_GPU_TEXTURE_GLSL

// Samples textures from the scene's texture pages, bilinearly, with the wrapping of each texture.
// Needs: textures (TextureRecord[]), texture_pages (texture2DArray).

vec3 linear_from_srgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

int wrap_texel(int i, int size, uint mode) {
    if (mode == 2u) return clamp(i, 0, size - 1);
    int period = mode == 1u ? 2 * size : size;
    int j = i - period * int(floor(float(i) / float(period)));  // 0 .. period - 1
    j = clamp(j, 0, period - 1);
    return j < size ? j : 2 * size - 1 - j;
}

vec4 fetch_texel(TextureRecord t, ivec2 i) {
    ivec2 at = ivec2(t.x, t.y) + ivec2(wrap_texel(i.x, int(t.width), t.wrap_u), wrap_texel(i.y, int(t.height), t.wrap_v));
    vec4 texel = texelFetch(texture_pages, ivec3(at, t.page), 0);
    if ((t.flags & PELLUCID_TEXTURE_SRGB) != 0u) texel.rgb = linear_from_srgb(texel.rgb);
    return texel;
}

// The texture's value; white if the material has no texture.
vec4 sample_texture(uint index, vec2 first_set, vec2 second_set) {
    if (index == PELLUCID_NO_TEXTURE) return vec4(1.0);
    TextureRecord t = textures[index];
    vec3 texcoord = vec3((t.flags & PELLUCID_TEXTURE_SECOND_SET) != 0u ? second_set : first_set, 1.0);
    vec2 uv = vec2(dot(t.uv_row0.xyz, texcoord), dot(t.uv_row1.xyz, texcoord));
    // Reduce uv to two periods, because rounding would spoil far repetitions. A mirrored texture has a period of two.
    uv.x = t.wrap_u == 2u ? clamp(uv.x, -1.0, 2.0) : uv.x - 2.0 * floor(0.5 * uv.x);
    uv.y = t.wrap_v == 2u ? clamp(uv.y, -1.0, 2.0) : uv.y - 2.0 * floor(0.5 * uv.y);
    vec2 position = uv * vec2(t.width, t.height);
    if ((t.flags & PELLUCID_TEXTURE_NEAREST) != 0u) return fetch_texel(t, ivec2(floor(position)));
    position -= 0.5;
    ivec2 low = ivec2(floor(position));
    vec2 weight = position - vec2(low);
    return mix(mix(fetch_texel(t, low), fetch_texel(t, low + ivec2(1, 0)), weight.x),
               mix(fetch_texel(t, low + ivec2(0, 1)), fetch_texel(t, low + ivec2(1, 1)), weight.x), weight.y);
}

#endif
