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
    const GpuImage& depth;     ///< R32F, metres; PELLUCID_EMPTY_DEPTH: no surface
    const GpuImage& object;    ///< R32UI, index of its object; undefined without a surface
    const GpuImage& triangle;  ///< R32UI, index over all objects; PELLUCID_NO_TRIANGLE: no surface
};

class LayerSource;

/// Per pixel, the glass surfaces that the view ray crosses, nearest first.
///
/// Layer k of the images describes the k-th surface:
/// - `depth` (R32F): linear eye depth in metres; PELLUCID_EMPTY_DEPTH without a k-th surface.
/// - `triangle` (R32UI): index over all objects, with PELLUCID_BACK_FACE if the view ray leaves the solid;
///   PELLUCID_NO_TRIANGLE without a k-th surface.
/// - `normal` (R32UI): interpolated world normal, octahedral; undefined without a k-th surface.
/// find_object() in objects.glsl finds the object of a triangle.
///
/// Every builder orders surfaces by depth, and surfaces of equal depth by triangle index.
struct Layers {
    const GpuImage& depth;
    const GpuImage& triangle;
    const GpuImage& normal;
    const Buffer& covered;  ///< list of pixels that have layers (pixel_list.glsl); arguments of compute_indirect()
    std::uint32_t count;
    const Opaque& opaque;
    LayerSource& source;  ///< builds more layers, for techniques that process objects one by one
    std::vector<Binding> group = {reads("layer_depth", depth),           reads("layer_triangle", triangle),
                                  reads("layer_normal", normal),         reads("PixelList", covered),
                                  reads("opaque_depth", opaque.depth),   reads("opaque_radiance", opaque.radiance),
                                  reads("opaque_object", opaque.object), reads("opaque_triangle", opaque.triangle)};
    /// Binds all images by their names in shaders. "PixelList" is `covered`, unless the pass binds another list.
    Binding bindings() const { return all_of(group); }
};

/// Bytes of a fragment in its list; twin of Node in fragment_list.glsl.
inline constexpr vk::DeviceSize kFragmentNodeSize = 12;

/// The layers that a technique wants.
struct LayerRequest {
    std::span<const DrawCall> solids;
    std::uint32_t count;
    /// True: a pixel has no layers if its first glass surface lies behind an opaque surface. Opaque surfaces farther
    /// back hide no layers. False: opaque surfaces hide no layers at all.
    bool hidden_by_opaque = true;
    /// Requests of different names may be used together. A request replaces an earlier one of the same name.
    std::string name = "layer";
};

/// Initial capacity for the fragments of the single pass.
struct FragmentPool {
    std::uint32_t capacity = 0;  ///< fragments; 0: automatic
    std::uint32_t bands = 1;     ///< number of horizontal bands of the image
};

/// Measurements of dual depth peeling in one frame, which the next frame uses. They are kept until another scene or
/// image size is set. So a single crowded pixel in one view makes later views peel one by one.
struct DualPeeling {
    std::uint32_t extra_peels = 0;      ///< peels beyond half the layers, for rays that cross more surfaces than layers
    bool measuring = false;             ///< the frame runs the largest number of passes, to count the needed ones
    bool crowded = false;               ///< three surfaces share a depth; only peeling one by one separates them
    std::optional<glm::uvec2> counted;  ///< counts of the frame that has run: needed extra peels, crowded pixels
};

/// Builds the layers of a frame, for any number of requests. Lives from frame to frame, and learns from each frame the
/// capacity that the next one needs.
class LayerSource {
public:
    explicit LayerSource(FragmentPool pool = {}) : bands_(pool.bands) {
        counted("fragments", kFragmentNodeSize).set_capacity(pool.capacity);
    }

    /// Call before the first build() of a frame.
    void begin_frame(LayerBuilder builder) { builder_ = builder, geometry_passes_ = 0; }
    Layers build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    /// Builds a map of the view from every triangle of the scene. Call once per frame; needs GpuScene::topology.
    SurfaceMap map_view(Recorder& recorder, const Frame& frame);
    /// Whether the view contains the boxes of all glass. If so, the view's map holds all surfaces that paths inside
    /// glass can meet.
    static bool view_holds_glass(const Frame& frame);
    /// Lists every triangle of the scene in the texels of a projection.
    SurfaceMap map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                            const MapProjection& projection);
    /// A buffer of a technique. It keeps its capacity from frame to frame, and must_repeat() checks it, too.
    CountedBuffer& counted(const std::string& name, vk::DeviceSize item_size,
                           vk::Format texels = vk::Format::eUndefined, bool host_visible = false) {
        return counted_.try_emplace(name, name, item_size, texels, host_visible).first->second;
    }
    /// Maps of every mesh in the mesh's own frame. Builds maps of new and moved meshes. Call once per frame.
    SurfaceMap map_meshes(Recorder& recorder, const Frame& frame, std::uint32_t resolution) {
        return mesh_maps_.bring_up_to_date(recorder, frame, resolution);
    }
    /// Reports paths that the view's map has lost. From then on maps of the meshes finish such paths, in the repeated
    /// frame and in later frames.
    void note_lost_paths(std::uint32_t count) { paths_lost_ = paths_lost_ || count > 0; }
    bool finishes_paths() const { return finishes_paths_; }
    /// Requests that the frame be recorded again, because data of a technique exceeded its capacity.
    void repeat() { repeats_ = true; }
    /// Resets all state that depends on the image size. Maps of meshes are kept.
    void forget_size();
    /// Call after the frame has run. True if data exceeded a capacity: the capacity has grown, and the frame must be
    /// recorded again. Throws Error if the device does not have the memory.
    bool must_repeat(const Frame& frame);
    /// Names of the data that exceeded their capacity, or were lost, when must_repeat() was last true.
    const std::vector<std::string>& outgrown() const { return outgrown_; }
    /// Number of geometry passes in this frame so far. Every band of the image counts as one.
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
    std::uint32_t bands_;  ///< number of horizontal bands of the image; the buffer holds the fragments of one band
    DualPeeling dual_;
    std::map<std::string, CountedBuffer> counted_;
    MeshMaps mesh_maps_;
    std::vector<std::string> outgrown_;
    bool paths_lost_ = false, finishes_paths_ = false, repeats_ = false;
};

}  // namespace pellucid
