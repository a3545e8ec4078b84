#ifndef PELLUCID_TECHNIQUES_IHRKE_2007_LIGHT_BINDINGS_GLSL
#define PELLUCID_TECHNIQUES_IHRKE_2007_LIGHT_BINDINGS_GLSL

// Volumes, and the light traced through them (volume/wavefront.h).
#include "volume/light_records.h"
#include "volume/volume_record.glsl"

layout(std430, set = 0, binding = 30) readonly buffer Volumes { VolumeRecord volumes[]; };
layout(std430, set = 0, binding = 32) readonly buffer Placements { LightPlacement placements[]; };
layout(set = 0, binding = 36) uniform texture3D light_irradiance;
layout(set = 0, binding = 37) uniform texture3D light_direction;
#include "volume/light_lookup.glsl"
#include "volume/volume_boxes.glsl"

#endif
