#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_VISIBILITY_BINDINGS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_VISIBILITY_BINDINGS_GLSL

// What the passes of this technique share. Programs are made for what there is in the scene.
#extension GL_GOOGLE_include_directive : require
#include "gpu/frame.glsl"

layout(constant_id = 0) const uint kMediumWords = 1u;     // of PathMedia per path: 32 slots each
layout(constant_id = 1) const bool kOneObject = false;    // whose record is then the same for all paths
layout(constant_id = 2) const bool kTree = false;         // what is reflected is followed, too
layout(constant_id = 3) const bool kStochastic = false;   // one way at random
layout(constant_id = 4) const bool kDispersive = false;   // some glass disperses
layout(constant_id = 5) const bool kRough = false;        // some glass is rough

layout(constant_id = 13) const bool kTexturedGlass = false;  // some glass varies along its surface
layout(constant_id = 12) const bool kManySlots = false;   // some body has several
layout(constant_id = 14) const bool kCrossing = false;    // some shell crosses itself
layout(constant_id = 8) const bool kMapPerMesh = false;   // otherwise there is one map of all the scene
layout(constant_id = 9) const bool kTouching = false;     // surfaces of two shells may lie at one place
layout(constant_id = 15) const bool kFoundOnHost = false; // surfaces are found by the host, in no map
layout(constant_id = 40) const bool kFromLight = false;   // paths are photons: weights are flux, W
layout(constant_id = 41) const bool kPhotons = false;     // lights throw caustics,
layout(constant_id = 42) const bool kPhotonsOfEmitters = false;     // emissive surfaces,
layout(constant_id = 43) const bool kPhotonsOfEnvironment = false;  // and the environment
layout(constant_id = 29) const bool kLightsSurfaces = false;  // paths look from opaque surfaces to lights, and to each other
layout(constant_id = 31) const bool kFullLight = false;       // what facets of opaque surfaces reflect is followed, too
layout(constant_id = 44) const bool kGathers = false;  // paths sample the irradiance of the first diffuse surface they meet
layout(constant_id = 48) const bool kConverges = false;  // a still of full light has samples enough for noise instead of errors
layout(constant_id = 11) const bool kVolumes = false;     // there are volumes between surfaces, in which paths bend

// Whether each sample meets one facet of rough glass. Otherwise a lobe stands for all.
bool samples_facets() { return kRough && (kStochastic || kTree); }

layout(std430, set = 0, binding = 1) readonly buffer Objects { ObjectRecord objects[]; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialRecord materials[]; };
#include "layers/layers.glsl"
#include "layers/objects.glsl"
#include "layers/pixel_list.glsl"
#include "layers/corner_weights.glsl"
#include "techniques/refraction.glsl"

layout(local_size_x = PELLUCID_LIST_GROUP) in;

// Twin of PathPush in paths.h.
layout(push_constant) uniform Push {
    uint max_events;       // K: paths that meet one more surface end
    uint most_branches;    // that leave the paths of a pixel
    float threshold;       // what carries less does not branch off
    uint branch_capacity;
    float coincidence;     // m: by so much the places of surfaces are uncertain
    uint closing;          // 1: the last pass; all that waits ends where it is
    uint volume_count;
    uint proxy;            // 1: rays enter what a volume stands for at its surface; 0: it is as if that were not there;
                           // kSharpInterfaces: solids hold volumes, whose index holds up to their surfaces
    uint light_count;      // of the scene, 0 where they are not drawn
    uint whole_picture;    // 1: paths start at the eye and shade all that they meet, the first surface included
    uint eye_differs;      // 1: what the eye is inside of differs from ray to ray
    float eye_depth;       // m, of the plane on which rays start
    float largest_contact; // m, see contact_distance()
    uint direct_lights;    // of the scene, whose light opaque surfaces reflect
    uint tinted_shadows;   // 1: glass lets shadow rays pass, weakened; 0: it blocks them
    uint most_bounces;     // diffuse reflections along a path
    uint emitter_count;    // triangles that emit light, to whose points shadow rays go; 0: none
    uint behind_glass;     // 1: opaque surfaces that pixels show behind glass are lit, too
};

const uint kSharpInterfaces = 2u;

uint object_of(uint triangle) { return kOneObject ? 0u : find_object(triangle); }

#endif
