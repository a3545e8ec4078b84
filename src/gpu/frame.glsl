#ifndef PELLUCID_GPU_FRAME_GLSL
#define PELLUCID_GPU_FRAME_GLSL

// Binding 0 of every shader that needs the camera or the environment.
#include "gpu/structs.h"
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameConstants frame; };
#include "gpu/camera.glsl"

#endif
