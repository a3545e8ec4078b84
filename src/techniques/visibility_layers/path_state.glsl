#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL

// Paths between two passes, one per pixel; in world space.
// Needs: techniques/refraction.glsl.

layout(constant_id = 0) const uint kMediumWords = 1u;  // of PathMedia per path: eight solids each

layout(std430, set = 0, binding = 10) buffer PathPlaces { vec4 path_places[]; };    // w: bits of the triangle there
layout(std430, set = 0, binding = 11) buffer PathWays { vec4 path_ways[]; };        // direction; length inside, m
layout(std430, set = 0, binding = 12) buffer PathWeights { vec4 path_weights[]; };  // transmittance; bits of the events
layout(std430, set = 0, binding = 13) buffer PathMedia { uint path_media[]; };

// The solids around a path: per rank, in four bits, how often it was entered more than left.
uint media[kMediumWords];

uint entered(uint rank) { return (media[rank / 8u] >> (rank % 8u * 4u)) & 15u; }

void set_entered(uint rank, uint count) {
    uint shift = rank % 8u * 4u;
    media[rank / 8u] = (media[rank / 8u] & ~(15u << shift)) | min(count, 15u) << shift;
}

const uint kAir = 0xffffffffu;

// The rank of the solid that fills the place: the highest of those around it.
uint filling_rank() {
    uint rank = kAir;
    for (uint word = 0u; word < kMediumWords; ++word) {
        if (media[word] != 0u) rank = word * 8u + uint(findMSB(media[word])) / 4u;
    }
    return rank;
}

uint standing;  // the triangle that the path stands on

Path load_path(uint i) {
    vec4 place = path_places[i], way = path_ways[i], weight = path_weights[i];
    uint word = floatBitsToUint(weight.w);
    standing = floatBitsToUint(place.w);
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = path_media[i * kMediumWords + w];
    return Path(place.xyz, way.xyz, weight.rgb, way.w, word & 0xfffu, (word >> 12) & 0xfffu, (word >> 24) & 0xfu,
                ((word >> 28) & 1u) != 0u);
}

void save_path(uint i, Path path) {
    path_places[i] = vec4(path.position, uintBitsToFloat(standing));
    path_ways[i] = vec4(path.direction, path.length_inside);
    path_weights[i] = vec4(path.transmittance, uintBitsToFloat(pack_events(path)));
    for (uint w = 0u; w < kMediumWords; ++w) path_media[i * kMediumWords + w] = media[w];
}

#endif
