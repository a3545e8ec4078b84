#version 460
#extension GL_GOOGLE_include_directive : require
#include "techniques/visibility_layers/begin_at_eye.glsl"
