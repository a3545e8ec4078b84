#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_STATE_GLSL

// Paths between two passes: one per pixel is on its way, those that have branched off it wait; in world space.
// Needs: techniques/refraction.glsl.
#include "gpu/largest.glsl"

layout(std430, set = 0, binding = 10) buffer PathPlaces { vec4 path_places[]; };    // w: bits of the triangle there
layout(std430, set = 0, binding = 11) buffer PathWays { vec4 path_ways[]; };        // direction; length inside, m
layout(std430, set = 0, binding = 12) buffer PathWeights { vec4 path_weights[]; };  // transmittance; bits of the events
layout(std430, set = 0, binding = 13) buffer PathMedia { uint path_media[]; };      // what it is inside of, and its mark
// What waits: per pixel the last branch's number + 1, and how many there have been; per branch kBranchWords.
layout(std430, set = 0, binding = 23) buffer Waiting { uvec2 waiting[]; };
layout(std430, set = 0, binding = 24) buffer Branches { uint branch_count, branch_reserved[3]; uvec4 branches[]; };

// What a path is inside of: a bit per slot (object_traits.glsl) for whether it is inside a shell of that slot.
// A specialization constant sizes it, so GLSL passes it to functions but does not assign it.
struct Media {
    uint words[kMediumWords];
};

uint media_word(Media media, uint slot) { return media.words[kMediumWords == 1u ? 0u : slot / 32u]; }
bool is_inside(Media media, uint slot) { return (media_word(media, slot) >> slot % 32u & 1u) != 0u; }

void set_inside(inout Media media, uint slot, bool inside) {
    uint bit = 1u << slot % 32u, word = media_word(media, slot);
    media.words[kMediumWords == 1u ? 0u : slot / 32u] = inside ? word | bit : word & ~bit;
}

void clear_media(out Media media) {
    for (uint w = 0u; w < kMediumWords; ++w) media.words[w] = 0u;
}
void copy_media(Media from, out Media media) {
    for (uint w = 0u; w < kMediumWords; ++w) media.words[w] = from.words[w];
}

const uint kAir = 0xffffffffu;

// A path on its way.
struct PathState {
    Path path;      // world space
    Media media;
    uint standing;  // the triangle that it stands on
    uint mark;      // bits of the kinds below, and how far rough surfaces have spread it (kSpreadShift)
    uint pixel;     // its number
    uint seed;      // of its random choices
};

const uint kChannelMask = 3u;   // 0: all channels, 1 to 3: red, green, blue
const uint kMainPath = 4u;      // the one that Refraction is about
const uint kOuterBranch = 8u;   // reflected by the first surface, before the glass
const uint kMetOpaque = 16u;    // it has ended on the opaque triangle on which it stands
const uint kBounced = 32u;      // scattered by an opaque surface: it looks for what hides or lights that surface
const uint kEntersVolume = 64u; // it stands at the box of a volume
const uint kCrossedVolume = 128u;
const uint kFromGlass = kEntersVolume;  // scattered by rough glass, and in no mirror or refraction since: shadow rays have brought
                                        // what lights send there. Where shadow rays look from surfaces, no path enters a volume
const uint kLost = 256u;        // the map cannot say what it meets: another will
const uint kToLight = 512u;     // a shadow ray: it goes straight to a light, `length_inside` metres away
const uint kOpaquePixel = 1024u;  // its light is that of the opaque surface which the pixel shows
const uint kMetLamp = 16384u;     // it has ended on a lamp, whose radiance its transmittance includes
const uint kUnbent = 32768u;    // scattered by an opaque surface, or by glass so rough that it looks at emissive surfaces, and in no mirror or refraction since. Photons: not bent yet, as
                                // far apart as they are at their targets
const uint kFromDiffuse = 65536u;  // reflected diffusely; since then by nothing but what photons follow
const uint kScatteredShift = 17u, kScatteredMask = 3u << kScatteredShift;  // times that it was scattered: none, one, more
const uint kBent = 1u << 19u;   // mirrored or refracted since
const uint kBounceShift = 11u, kBounceMask = 7u << kBounceShift;  // diffuse reflections so far

bool has_mark(PathState state, uint bits) { return (state.mark & bits) != 0u; }

uint bounces(PathState state) { return (state.mark & kBounceMask) >> kBounceShift; }

const uint kSpreadShift = 20u, kSpreadUnits = 4095u;

// Alpha of the lobe that a mark stands for, 0..1.
float spread_of(uint mark) { return float(mark >> kSpreadShift) / float(kSpreadUnits); }
uint without_spread(uint mark) { return mark & ((1u << kSpreadShift) - 1u); }
uint widened(uint mark, float alpha) {
    float sum = min(sqrt(spread_of(mark) * spread_of(mark) + alpha * alpha), 1.0);
    return without_spread(mark) | uint(sum * float(kSpreadUnits) + 0.5) << kSpreadShift;
}

// The mark of a path that meets a surface: `scatters`, or one that only mirrors and refracts.
uint after_surface(uint mark, bool scatters) {
    if (!scatters) return mark | kBent;
    uint before = (mark & kScatteredMask) >> kScatteredShift;
    return (mark & ~(kScatteredMask | kBent)) | min(before + 1u, 2u) << kScatteredShift;
}

// The part of the picture (gpu/light_parts.glsl) that light belongs to which such a path meets,
uint part_met(uint mark) {
    uint scattered = (mark & kScatteredMask) >> kScatteredShift;
    if (scattered != 1u) return scattered == 0u ? PELLUCID_EMITTED : PELLUCID_INDIRECT;
    return (mark & kBent) != 0u ? PELLUCID_CAUSTIC : PELLUCID_DIRECT;
}

// and light that comes as `first` to a surface which scatters it into the path.
uint part_through(uint mark, uint first) { return (mark & kScatteredMask) == 0u ? first : PELLUCID_INDIRECT; }

Path unpack_path(vec4 place, vec4 way, vec4 weight) {
    uint word = floatBitsToUint(weight.w);
    return Path(place.xyz, way.xyz, weight.rgb, way.w, word & 0xfffu, (word >> 12) & 0xfffu, (word >> 24) & 0xfu,
                ((word >> 28) & 1u) != 0u);
}

// The path of pixel i that is on its way.
void load_path(uint i, uint seed, out PathState state) {
    state.path = unpack_path(path_places[i], path_ways[i], path_weights[i]);
    for (uint w = 0u; w < kMediumWords; ++w) state.media.words[w] = path_media[i * (kMediumWords + 1u) + w];
    state.standing = floatBitsToUint(path_places[i].w);
    state.mark = path_media[i * (kMediumWords + 1u) + kMediumWords];
    state.pixel = i;
    state.seed = seed;
}

void save_path(PathState state) {
    uint i = state.pixel;
    path_places[i] = vec4(state.path.position, uintBitsToFloat(state.standing));
    path_ways[i] = vec4(state.path.direction, state.path.length_inside);
    path_weights[i] = vec4(state.path.transmittance, uintBitsToFloat(pack_events(state.path)));
    for (uint w = 0u; w < kMediumWords; ++w) path_media[i * (kMediumWords + 1u) + w] = state.media.words[w];
    path_media[i * (kMediumWords + 1u) + kMediumWords] = state.mark;
}

const uint kBranchVectors = 4u + (kMediumWords + 1u) / 4u;  // the path's three, then media, mark and the next branch

// Lets a path wait behind that of its pixel. False: there is no room (counted: the host makes more). `counts`: it is one of
// the most_branches.
bool push_branch(PathState state, uint capacity, bool counts) {
    uint number = atomicAdd(branch_count, 1u);
    if (number >= capacity) return false;
    uint at = number * kBranchVectors;
    branches[at] = floatBitsToUint(vec4(state.path.position, uintBitsToFloat(state.standing)));
    branches[at + 1u] = floatBitsToUint(vec4(state.path.direction, state.path.length_inside));
    branches[at + 2u] = uvec4(floatBitsToUint(state.path.transmittance), pack_events(state.path));
    uvec4 words = uvec4(waiting[state.pixel].x, state.mark, 0u, 0u);
    for (uint w = 0u; w < kMediumWords; ++w) {
        words[(w + 2u) % 4u] = state.media.words[w];
        if ((w + 2u) % 4u == 3u || w + 1u == kMediumWords) branches[at + 3u + (w + 2u) / 4u] = words;
    }
    waiting[state.pixel] = uvec2(number + 1u, waiting[state.pixel].y + uint(counts));
    return true;
}

// The branch of the pixel that has come last. False: none waits.
bool pop_branch(inout PathState state) {
    uint head = waiting[state.pixel].x;
    if (head == 0u) return false;
    uint at = (head - 1u) * kBranchVectors;
    uvec4 weight = branches[at + 2u], words = branches[at + 3u];
    state.path = unpack_path(uintBitsToFloat(branches[at]), uintBitsToFloat(branches[at + 1u]), uintBitsToFloat(weight));
    state.standing = branches[at].w;
    waiting[state.pixel].x = words.x;
    state.mark = words.y;
    for (uint w = 0u; w < kMediumWords; ++w) state.media.words[w] = branches[at + 3u + (w + 2u) / 4u][(w + 2u) % 4u];
    return true;
}

#endif
