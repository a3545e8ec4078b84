#ifndef PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_LIGHTS_GLSL
#define PELLUCID_TECHNIQUES_VISIBILITY_LAYERS_PATH_LIGHTS_GLSL

// The scene's lights, for paths.
#include "gpu/punctual_light.glsl"

layout(constant_id = 30) const uint kVisibleLights = 0u;
layout(std430, set = 0, binding = 48) readonly buffer SceneLights { PunctualLight scene_lights[]; };
#include "gpu/visible_lights.glsl"

#endif
