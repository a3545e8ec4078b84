#ifndef PELLUCID_LAYERS_OBJECTS_GLSL
#define PELLUCID_LAYERS_OBJECTS_GLSL

// The object that a triangle belongs to.
// Needs: frame (FrameConstants), objects (ObjectRecord[]).

uint find_object(uint triangle) {
    uint low = 0u, high = frame.object_count;  // objects[low] starts at or before the triangle
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (objects[middle].first_triangle <= triangle) low = middle;
        else high = middle;
    }
    return low;
}

#endif
