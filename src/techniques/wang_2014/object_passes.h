#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Twin of Push in ray_state.glsl: the object, and how it is searched.
struct ObjectSearch {
    glm::vec4 box_low, box_high;  ///< x and y in view space, depth, m
    std::uint32_t object;
    std::uint32_t layer = 0;
    std::uint32_t linear_steps, binary_steps;
    std::uint32_t last_reflection = 0;
};

/// The passes of Wang 2014 over one object: from the rays that may meet it to those that have passed it.
class ObjectPasses {
public:
    /// `seen` are layers of all solids together, `layers` of the object alone.
    ObjectPasses(Recorder& recorder, const Frame& frame, const Layers& seen, const Layers& layers,
                 const Refraction& refraction, const ObjectSearch& search);

    /// Rays of `pixels` look for a way in through a layer; returns the pixels of those that find one.
    const Buffer& enter(const Buffer& pixels, std::uint32_t layer);
    /// Rays of `pixels` look for their way out through a layer, with total reflections in between; returns the
    /// pixels of those that find it. `from_eye`: they are view rays that have yet to pass the first surface.
    const Buffer& leave(const Buffer& pixels, std::uint32_t layer, std::uint32_t reflections, bool from_eye);

private:
    /// Section 3.5.2: a deeper layer that is empty takes the layer of its kind before it.
    struct MergedLayers {
        const GpuImage& depth;
        const GpuImage& normal;
        const Buffer& entry_limit;  ///< depth of the farthest entry
    };
    static MergedLayers merge_layers(Recorder& recorder, const Frame& frame, const Layers& layers);

    Recorder& recorder_;
    const Frame& frame_;
    const Layers& seen_;
    const Layers& layers_;
    const Refraction& refraction_;
    ObjectSearch search_;
    MergedLayers merged_;
};

}  // namespace pellucid
