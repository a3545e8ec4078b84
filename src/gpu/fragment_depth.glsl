#ifndef PELLUCID_GPU_FRAGMENT_DEPTH_GLSL
#define PELLUCID_GPU_FRAGMENT_DEPTH_GLSL

// Depth of a fragment along -Z of the view, m; the same for every shader, so that coincident surfaces stay so.
// Needs: frame (FrameConstants).

// The rasteriser interpolates 1/depth and z in any case: a varying for the depth would cost every triangle more.
float eye_depth() {
    return frame.orthographic != 0u ? mix(frame.near_plane, frame.far_plane, gl_FragCoord.z) : 1.0 / gl_FragCoord.w;
}

#endif
