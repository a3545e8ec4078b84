#pragma once

#include "techniques/technique.h"

namespace pellucid {

/// Twin of Push in ray_state.glsl: the object, and the search settings.
struct ObjectSearch {
    glm::vec4 box_low, box_high;  ///< x and y in view space, depth, m
    std::uint32_t object;
    std::uint32_t layer = 0;
    std::uint32_t linear_steps, binary_steps;
    std::uint32_t last_reflection = 0;
    float fault_size;  ///< SIZE, m
};

/// Choices for the search of exits, as in search_exit.glsl.
struct ExitSearch {
    std::uint32_t below_faults;
    bool front_exits, steep_walls;
    bool counts_steps;  ///< lengths of paths are numbers of steps
    bool silhouettes;   ///< beside the object a ray is behind exits, so a step beyond the silhouette is refined
};

/// The passes of Wang 2014 for one object, from its candidate rays to the rays that have passed it.
class ObjectPasses {
public:
    /// `seen`: layers of all solids together; `layers`: layers of the object alone.
    ObjectPasses(Recorder& recorder, const Frame& frame, const Layers& seen, const Layers& layers,
                 const Refraction& refraction, const ObjectSearch& search, const ExitSearch& exits);

    /// Searches a layer for entries of the rays of `pixels`. Returns the pixels of rays that found one.
    const Buffer& enter(const Buffer& pixels, std::uint32_t layer);
    /// Searches a layer for exits of the rays of `pixels`, with total reflections in between. Returns the pixels of
    /// rays that found one. `from_eye`: they are view rays before the first surface.
    const Buffer& leave(const Buffer& pixels, std::uint32_t layer, std::uint32_t reflections, bool from_eye);

private:
    /// Section 3.5.2: empty texels of a deeper layer take the previous layer of the same kind.
    struct MergedLayers {
        const GpuImage& depth;
        const GpuImage& normal;
        const Buffer& entry_limit;  ///< depth of the farthest entry
    };
    static MergedLayers merge_layers(Recorder& recorder, const Frame& frame, const Layers& layers, bool silhouettes);

    Recorder& recorder_;
    const Frame& frame_;
    const Layers& seen_;
    const Layers& layers_;
    const Refraction& refraction_;
    ObjectSearch search_;
    ExitSearch exits_;
    MergedLayers merged_;
};

}  // namespace pellucid
