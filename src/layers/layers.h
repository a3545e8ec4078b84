#pragma once

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
};

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

/// Room for the fragments of the single pass: measured in one frame, used in the next.
struct FragmentPool {
    std::uint32_t capacity = 0;  ///< fragments; 0: choose
    std::uint32_t bands = 1;     ///< the picture is done in this many horizontal bands
    std::uint32_t builds = 1;    ///< a frame makes at most this many, or one of each solid of glass and of all
};

/// Room for a surface map; likewise. 0: choose.
struct MapPool {
    std::uint32_t records = 0;
    std::uint32_t tiles = 0;  ///< that large triangles are cut into
};

/// What dual depth peeling learnt of a scene: measured in one frame, used in the next. It is kept until another scene
/// or picture size is set, so a single crowded pixel in one view makes later views peel one by one.
struct DualPeeling {
    std::uint32_t extra_peels = 0;  ///< beyond half the layers: view rays cross more surfaces than there are layers
    bool measuring = false;         ///< the frame makes all the passes that can be needed, to count those that are
    bool crowded = false;           ///< three surfaces at one depth, which only peeling one by one tells apart
};

/// Builds the layers of a frame, as often as it is asked to. Lives from frame to frame and learns from each how
/// much room the next one needs.
class LayerSource {
public:
    explicit LayerSource(FragmentPool pool = {}) : pool_(pool) {}

    /// Before the first build() of a frame.
    void begin_frame(LayerBuilder builder) { builder_ = builder, builds_ = geometry_passes_ = 0, mapped_ = false; }
    Layers build(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    /// A map of the view, in which every triangle of the scene is. Once per frame; needs GpuScene::topology.
    SurfaceMap map_view(Recorder& recorder, const Frame& frame);
    /// Whether the boxes of all glass lie in the view, so that paths inside it find all of its surfaces in a map of that.
    static bool view_holds_glass(const Frame& frame);
    /// Lists every triangle of the scene in the texels of a projection.
    SurfaceMap map_surfaces(Recorder& recorder, const Frame& frame, const SceneTopology& topology,
                            const MapProjection& projection);
    /// How many items of `name` a frame has room for, at first `guess`; what a frame counted is the next one's guess.
    std::uint32_t room(const std::string& name, std::uint32_t guess);
    /// The first word of `counter` is how many there were, once the frame has run.
    void measure_room(Recorder& recorder, const Frame& frame, const std::string& name, const Buffer& counter);
    /// Maps of every mesh, each in its own frame, built where a mesh is new or has moved. Once per frame.
    SurfaceMap map_meshes(Recorder& recorder, const Frame& frame, std::uint32_t resolution) {
        return mesh_maps_.bring_up_to_date(recorder, frame, resolution);
    }
    /// Forgets what it has learnt of pictures of one size, and keeps what holds for all.
    void forget_size();
    /// After the frame has run: true if something did not fit. What build() does next will, and the frame must be
    /// recorded again. Throws Error if the device has no room for it.
    bool must_repeat(const Frame& frame);
    /// How often the frame's builds drew their solids so far; bands of a picture count as one each.
    std::uint32_t geometry_passes() const { return geometry_passes_; }

private:
    Layers peel(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    Layers peel_dual(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    Layers gather(Recorder& recorder, const Frame& frame, const Opaque& opaque, const LayerRequest& request);
    bool must_enlarge_rooms();
    bool must_peel_more(const Frame& frame);
    struct FragmentBand;
    void rasterise_fragments(Recorder& recorder, const Frame& frame, const LayerRequest& request,
                             const FragmentBand& band);
    bool must_enlarge_pool(const Frame& frame);
    bool must_enlarge_tiles(const Frame& frame);
    bool must_enlarge_map(const Frame& frame);
    bool must_rebuild_layers(const Frame& frame);

    LayerBuilder builder_ = LayerBuilder::kSinglePass;
    std::uint32_t builds_ = 0;  ///< in this frame, that counted something
    std::uint32_t geometry_passes_ = 0;
    FragmentPool pool_;
    std::uint32_t tile_capacity_ = 0;  ///< that large triangles are cut into; 0: choose
    DualPeeling dual_;
    struct Room {
        std::uint32_t capacity = 0;
        const Buffer* counted = nullptr;  ///< on the host; in this frame
    };
    std::map<std::string, Room> rooms_;
    MapPool map_pool_;
    bool mapped_ = false;  ///< in this frame
    MeshMaps mesh_maps_;
};

}  // namespace pellucid
