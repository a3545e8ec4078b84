#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL

// Paths between two passes: one per pixel is on its way, those that have branched off it wait; in world space.
// Needs: techniques/refraction.glsl.

layout(std430, set = 0, binding = 10) buffer PathPlaces { vec4 path_places[]; };    // w: bits of the triangle there
layout(std430, set = 0, binding = 11) buffer PathWays { vec4 path_ways[]; };        // direction; length inside, m
layout(std430, set = 0, binding = 12) buffer PathWeights { vec4 path_weights[]; };  // transmittance; bits of the events
layout(std430, set = 0, binding = 13) buffer PathMedia { uint path_media[]; };      // what it is inside of, and its mark
// What waits: per pixel the last branch's number + 1, and how many there have been; per branch kBranchWords.
layout(std430, set = 0, binding = 23) buffer Waiting { uvec2 waiting[]; };
layout(std430, set = 0, binding = 24) buffer Branches { uint branch_count, branch_reserved[3]; uvec4 branches[]; };

// Where a path is: a bit per slot (object_traits.glsl) for whether it is inside a shell of that slot.
uint media[kMediumWords];

bool inside_slot(uint slot) { return (media[slot / 32u] >> slot % 32u & 1u) != 0u; }

void set_inside(uint slot, bool inside) {
    uint bit = 1u << slot % 32u;
    media[slot / 32u] = inside ? media[slot / 32u] | bit : media[slot / 32u] & ~bit;
}

const uint kAir = 0xffffffffu;

uint standing;  // the triangle that the path stands on

// What is known of a path besides: its colour channel, where it belongs, and how far rough surfaces have spread it.
uint mark;
const uint kChannelMask = 3u;   // 0: all channels, 1 to 3: red, green, blue
const uint kMainPath = 4u;      // the one that Refraction is about
const uint kOuterBranch = 8u;   // reflected by the first surface, before the glass
const uint kMetOpaque = 16u;    // it has ended on the opaque triangle on which it stands
const uint kBounced = 32u;      // scattered by an opaque surface: it looks for what hides or lights that surface
const uint kEntersVolume = 64u; // it stands at the box of a volume
const uint kCrossedVolume = 128u;

float spread() { return float(mark >> 16) / 65535.0; }  // alpha of the lobe that it stands for, 0..1
void widen(float alpha) {
    float sum = min(sqrt(spread() * spread() + alpha * alpha), 1.0);
    mark = (mark & 0xffffu) | uint(sum * 65535.0 + 0.5) << 16;
}

Path unpack_path(vec4 place, vec4 way, vec4 weight) {
    uint word = floatBitsToUint(weight.w);
    standing = floatBitsToUint(place.w);
    return Path(place.xyz, way.xyz, weight.rgb, way.w, word & 0xfffu, (word >> 12) & 0xfffu, (word >> 24) & 0xfu,
                ((word >> 28) & 1u) != 0u);
}

Path load_path(uint i) {
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = path_media[i * (kMediumWords + 1u) + w];
    mark = path_media[i * (kMediumWords + 1u) + kMediumWords];
    return unpack_path(path_places[i], path_ways[i], path_weights[i]);
}

void save_path(uint i, Path path) {
    path_places[i] = vec4(path.position, uintBitsToFloat(standing));
    path_ways[i] = vec4(path.direction, path.length_inside);
    path_weights[i] = vec4(path.transmittance, uintBitsToFloat(pack_events(path)));
    for (uint w = 0u; w < kMediumWords; ++w) path_media[i * (kMediumWords + 1u) + w] = media[w];
    path_media[i * (kMediumWords + 1u) + kMediumWords] = mark;
}

const uint kBranchVectors = 4u + (kMediumWords + 1u) / 4u;  // the path's three, then media, mark and the next branch

// Lets a path wait behind pixel i's. False: there is no room (counted: the host makes more).
bool push_branch(uint i, Path path, uint capacity) {
    uint number = atomicAdd(branch_count, 1u);
    if (number >= capacity) return false;
    uint at = number * kBranchVectors;
    branches[at] = floatBitsToUint(vec4(path.position, uintBitsToFloat(standing)));
    branches[at + 1u] = floatBitsToUint(vec4(path.direction, path.length_inside));
    branches[at + 2u] = uvec4(floatBitsToUint(path.transmittance), pack_events(path));
    uvec4 words = uvec4(waiting[i].x, mark, 0u, 0u);
    for (uint w = 0u; w < kMediumWords; ++w) {
        words[(w + 2u) % 4u] = media[w];
        if ((w + 2u) % 4u == 3u || w + 1u == kMediumWords) branches[at + 3u + (w + 2u) / 4u] = words;
    }
    waiting[i] = uvec2(number + 1u, waiting[i].y + 1u);
    return true;
}

// The branch that has come last. False: none waits.
bool pop_branch(uint i, out Path path) {
    uint head = waiting[i].x;
    if (head == 0u) return false;
    uint at = (head - 1u) * kBranchVectors;
    uvec4 weight = branches[at + 2u], words = branches[at + 3u];
    path = unpack_path(uintBitsToFloat(branches[at]), uintBitsToFloat(branches[at + 1u]), uintBitsToFloat(weight));
    waiting[i].x = words.x;
    mark = words.y;
    for (uint w = 0u; w < kMediumWords; ++w) media[w] = branches[at + 3u + (w + 2u) / 4u][(w + 2u) % 4u];
    return true;
}

#endif
