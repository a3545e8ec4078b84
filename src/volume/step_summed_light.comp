#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "volume/step_bindings.glsl"
#include "volume/sum_light.glsl"
#include "volume/step_light.glsl"
