#pragma once

#include "gpu/counted_buffer.h"
#include "gpu/frame.h"
#include "gpu/scene_topology.h"
#include "layers/mesh_maps.h"
#include "layers/surface_map.h"

#include <pellucid/layer_builder.h>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// The nearest opaque surface of each pixel.
struct Opaque {
    const GpuImage& radiance;  ///< RGBA32F, scene-linear
    const GpuImage& depth;     ///< R32F, metres; PELLUCID_EMPTY_DEPTH where there is none
    const GpuImage& object;    ///< R32UI, its index; undefined where there is none
    const GpuImage& triangle;  ///< R32UI, over all objects; PELLUCID_NO_TRIANGLE where there is none
};

class LayerSource;

/// Per pixel, the glass surfaces that the view ray crosses, nearest first.
///
/// Layer k of `depth` (R32F) holds linear eye depth in metres, PELLUCID_EMPTY_DEPTH where there is
/// no k-th surface; of `triangle` (R32UI) its index over all objects, with PELLUCID_BACK_FACE set where
/// the view ray leaves the solid, PELLUCID_NO_TRIANGLE where there is none; of `normal` (R32UI) the interpolated
/// world normal (octahedral), undefined where there is none. The object follows from the triangle (find_object in
/// objects.glsl).
///
/// Order is by depth and, where depths are equal, by triangle index, in every builder.
struct Layers {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
    const Buffer& covered;  ///< the pixels that have layers, see pixel_list.glsl; arguments of compute_indirect()
    std::uint32_t count;
    const Opaque& opaque;
    LayerSource& source;  ///< builds more, for techniques that look at objects one by one
    std::vector<Binding> group = {reads("layer_depth", depth),           reads("layer_triangle", triangle),
                                  reads("layer_normal", normal),         reads("PixelList", covered),
                                  reads("opaque_depth", opaque.depth),   reads("opaque_radiance", opaque.radiance),
                                  reads("opaque_object", opaque.object), reads("opaque_triangle", opaque.triangle)};
    /// All of this by the names that shaders have for it; "PixelList" is `covered`, unless the pass has another.
    Binding bindings() const { return all_of(group); }
};

/// Bytes of a fragment in its list; twin of Node in fragment_list.glsl.
inline constexpr vk::DeviceSize kFragmentNodeSize = 12;

/// Which layers are wanted.
struct LayerRequest {
    std::span<const DrawCall> solids;
    std::uint32_t count;
    /// A pixel whose first surface lies behind an opaque one has no layers; opaque surfaces further back cut
    /// nothing. False: nothing opaque hides anything.
    bool hidden_by_opaque = true;
    /// Layers of different names may be looked at side by side; those of one name replace each other.
    std::string name = "layer";
};

/// Capacity for the fragments of the single pass, to begin with.
struct FragmentPool {
    std::uint32_t capacity = 0;  ///< fragments; 0: choose
    std::uint32_t bands = 1;     ///< the picture is done in this many horizontal bands
};

/// What dual depth peeling learnt of a scene: measured in one frame, used in the next. It is kept until another scene
/// or picture size is set, so a single crowded pixel in one view makes later views peel one by one.
struct DualPeeling {
    std::uint32_t extra_peels = 0;      ///< beyond half the layers: view rays cross more surfaces than there are layers
    bool measuring = false;             ///< the frame makes all the passes that can be needed, to count those that are
    bool crowded = false;               ///< three surfaces at one depth, which only peeling one by one tells apart
    std::optional<glm::uvec2> counted;  ///< of the frame that has run: extra peels that it needs, crowded pixels
};

/// Builds the layers of a frame, as often as it is asked to. Lives from frame to frame and learns from each how
/// much room the next one needs.
class LayerSource {
public:
    explicit LayerSource(FragmentPool pool = {}) : bands_(pool.bands) {
        counted("fragments", kFragmentNodeSize).set_capacity(pool.capacity);
    }

    /// Before the first build() of a frame.
    void begin_frame(LayerBuilder builder) { builder_ = builder, geometry_passes_ = 0; }
    Layers build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    /// A map of the view, in which every triangle of the scene is. Once per frame; needs GpuScene::topology.
    SurfaceMap map_view(Recorder& recorder, const Frame& frame);
    /// Whether the boxes of all glass lie in the view, so that paths inside it find all of its surfaces in a map of that.
    static bool view_holds_glass(const Frame& frame);
    /// Lists every triangle of the scene in the texels of a projection.
    SurfaceMap map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                            const MapProjection& projection);
    /// A buffer of a technique, which lives as long as what it has learnt; must_repeat() looks at it, too.
    CountedBuffer& counted(const std::string& name, vk::DeviceSize item_size,
                           vk::Format texels = vk::Format::eUndefined, bool host_visible = false) {
        return counted_.try_emplace(name, name, item_size, texels, host_visible).first->second;
    }
    /// Maps of every mesh, each in its own frame, built where a mesh is new or has moved. Once per frame.
    SurfaceMap map_meshes(Recorder& recorder, const Frame& frame, std::uint32_t resolution) {
        return mesh_maps_.bring_up_to_date(recorder, frame, resolution);
    }
    /// Paths that the view's map has lost: once there are some, maps of the meshes are to finish them, in the frame that is
    /// then recorded again and in those that follow.
    void note_lost_paths(std::uint32_t count) { paths_lost_ = paths_lost_ || count > 0; }
    bool finishes_paths() const { return finishes_paths_; }
    /// The frame must be recorded again: something that a technique keeps did not fit.
    void repeat() { repeats_ = true; }
    /// Forgets what it has learnt of pictures of one size, and keeps what holds for all.
    void forget_size();
    /// After the frame has run: true if something did not fit. What build() does next will, and the frame must be
    /// recorded again. Throws Error if the device has no room for it.
    bool must_repeat(const Frame& frame);
    /// What must_repeat() found too small, or lost, when it was last true.
    const std::vector<std::string>& outgrown() const { return outgrown_; }
    /// How often the frame's builds drew their solids so far; bands of a picture count as one each.
    std::uint32_t geometry_passes() const { return geometry_passes_; }

private:
    Layers peel(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    Layers peel_dual(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    Layers gather(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    bool must_peel_more();
    struct FragmentBand;
    void rasterise_fragments(Recorder& recorder, const Frame& frame, const LayerRequest& request,
                             const FragmentBand& band);
    void cut_bands(const Frame& frame);

    LayerBuilder builder_ = LayerBuilder::kSinglePass;
    std::uint32_t geometry_passes_ = 0;
    std::uint32_t bands_;  ///< horizontal, of the picture, whose fragments fit one after the other
    DualPeeling dual_;
    std::map<std::string, CountedBuffer> counted_;
    MeshMaps mesh_maps_;
    std::vector<std::string> outgrown_;
    bool paths_lost_ = false, finishes_paths_ = false, repeats_ = false;
};

}  // namespace pellucid
