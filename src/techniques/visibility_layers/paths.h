#pragma once

#include "gpu/recorder.h"
#include "layers/host_finder.h"
#include "layers/layers.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

/// Twin of Push in visibility_bindings.glsl.
struct PathPush {
    std::uint32_t max_events, most_branches;
    float threshold;
    std::uint32_t branch_capacity;
    float coincidence;
    std::uint32_t closing;
    std::uint32_t volume_count;
    std::uint32_t proxy;
    std::uint32_t light_count;
    std::uint32_t whole_picture;
    std::uint32_t eye_differs;
    float eye_depth;
    float largest_contact;
    std::uint32_t direct_lights, tinted_shadows, most_bounces;
    std::uint32_t emitter_count, behind_glass;
};

/// What a pass that takes paths on is made of and binds, besides what is its own.
struct PathPass {
    Recorder& recorder;
    const Frame& frame;
    std::vector<Constant> constants;  ///< of visibility_bindings.glsl
    Binding bindings;                 ///< of paths, the maps that they walk, and what they leave
    PathPush push;
};

/// Volumes between surfaces, in which paths bend: what ihrke-2007 adds to paths.
class PathVolumes {
public:
    virtual ~PathVolumes() = default;
    virtual std::vector<Binding> bindings() const = 0;  ///< of volumes, and of their light
    virtual void set(PathPush& push) const = 0;
    /// Takes the paths of `entering` through volumes; into `next` or, where they end, `ended`.
    virtual void march(const PathPass& pass, const Buffer& entering, const Buffer& next, const Buffer& ended) const = 0;
    /// Ends paths, on what lights shine on where there are some.
    virtual ShaderCode end_shader() const = 0;
    /// Takes paths from surface to surface, where solids may hold volumes.
    virtual ShaderCode follow_shader() const = 0;
};

/// Texels of a mesh's maps along the longest side of its box, unless a parameter says otherwise.
inline constexpr std::uint32_t kMeshMapResolution = 512;

/// Who finds the surfaces that paths meet.
struct SurfaceFinder {
    SurfaceMap map;                                    ///< that paths walk, or what stands for it (of_triangles())
    const HostFinder* host = nullptr;                  ///< finds surfaces instead of the map
    const AccelerationStructure* hierarchy = nullptr;  ///< in which the device traces rays instead
    bool loses_paths = false;  ///< paths leave the map: they are counted, and end there where nothing finishes them
    std::optional<SurfaceMap> finishing = std::nullopt;  ///< takes them on

    /// That of lights and photons: Embree on devices whose memory is the host's, where GpuScene::host_finder is up to date; maps
    /// of the meshes elsewhere.
    static SurfaceFinder of_device(Recorder& recorder, const Frame& frame, LayerSource& source);
    /// `finder` is up to date; needs a device whose memory is the host's.
    static SurfaceFinder on_host(const HostFinder& finder);
    /// The device traces rays through `hierarchy`, which is up to date. Needs Device::ray_tracing().
    static SurfaceFinder traced(Recorder& recorder, const Frame& frame, const SceneHierarchy& hierarchy);
};

/// Which directions a path takes at a boundary: the refracted one; that, and the reflected one as a branch; or one of the
/// two at random.
enum class Ways { kTransmitted, kTree, kStochastic };

/// How paths begin, how far they go, and what becomes of them where they end.
struct PathTask {
    ShaderCode begin = {}, end = {};
    const Buffer* beginning = nullptr;  ///< pixels that `begin` is dispatched over; null: all of the frame
    /// Begins paths at their first end, in a dispatch over all of the frame, besides those of `begin`; none if empty.
    ShaderCode begin_at_end = {};
    bool full_light = false;       ///< what facets of opaque surfaces reflect is followed, too
    bool gathers = false;          ///< paths sample the irradiance of the first diffuse surface that they meet
    bool lights_surfaces = false;  ///< opaque surfaces at which paths end look to lights, and to what is around them
    std::vector<Binding> bindings = {};  ///< of `begin` and `end`, besides those of paths
    Ways ways = Ways::kTransmitted;
    bool ends_together = false;           ///< ends lead to no other paths, and can all be done after the last pass
    std::uint32_t surfaces_per_pass = 0;  ///< 0: chosen for the device
    /// max_events, most_branches, threshold, whole_picture, eye_differs, eye_depth; follow() fills in the rest.
    PathPush push{};
    const PathVolumes* volumes = nullptr;
    /// Whether rough glass looks to lights.
    bool looks_from_glass(const GpuScene& scene) const {
        return lights_surfaces && scene.rough_glass && (push.direct_lights > 0 || push.emitter_count > 0);
    }
    bool from_light = false;  ///< paths are photons: weights are flux, W, and count as the reversed paths would
};

/// Follows a path per pixel, and its branches, from surface to surface until all have ended.
void follow(Recorder& recorder, const Frame& frame, LayerSource& source, const SurfaceFinder& finder,
            const PathTask& task);

}  // namespace pellucid
