#ifndef PELLUCID_GPU_FRAGMENT_DEPTH_GLSL
#define PELLUCID_GPU_FRAGMENT_DEPTH_GLSL

// Depth of a fragment along -Z of the view, m. All shaders compute the same bits, so coincident surfaces stay
// coincident. Needs: frame (FrameConstants).

// The rasteriser interpolates 1/depth and z in any case. A varying for the depth would be an extra cost per triangle.
float eye_depth() {
    return frame.orthographic != 0u ? mix(frame.near_plane, frame.far_plane, gl_FragCoord.z) : 1.0 / gl_FragCoord.w;
}

#endif
