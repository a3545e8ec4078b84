#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "volume/step_bindings.glsl"
#include "volume/light_key.glsl"
#include "volume/brightest_light.glsl"
#include "volume/step_light.glsl"
