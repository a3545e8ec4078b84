#pragma once

#include "gpu/gpu_scene.h"
#include "layers/pixel_list.h"

#include <cstdint>
#include <memory>
#include <span>

namespace pellucid {

/// Paths that search for their next surface, in memory that host and device share. The layout is that of
/// path_state.glsl.
struct PathsOnHost {
    PixelListOnHost list;     ///< pixels of the searching paths
    std::uint32_t width;      ///< image width; pixel (x, y) has path `x + width y`
    const glm::vec4* places;  ///< positions, world, m; w: bits of the triangle on which the path stands
    const glm::vec4* ways;    ///< directions, unit, world
    std::uint32_t* media;     ///< per path: `words` words with a bit per slot that it is inside of, and a word of marks
    std::uint32_t words;
    float coincidence;  ///< uncertainty of positions, m
    bool touching;      ///< surfaces of several shells may coincide
};

/// A surface that a path may meet; twin of a texel of `candidates` in candidates.glsl.
struct Candidate {
    std::uint32_t triangle, traits;
};
/// Range of a path's candidates; twin of a texel of `candidate_lists`.
struct CandidateList {
    std::uint32_t first, count;
};
/// Results of a search, for the device. The first Candidate holds the largest candidate count of the frame's searches.
struct CandidatesOnHost {
    CandidateList* lists;  ///< per path
    std::span<Candidate> all;
};

/// Finds the surfaces that paths meet with Embree on the host's cores. Host and device must share memory, as on
/// software drivers.
///
/// A path's candidates are the nearest surface that it can meet, and surfaces that may coincide with that one. If the
/// nearest surface may lie behind the path, within rounding, the next surface is a candidate, too. The device
/// intersects the candidates itself (candidates.glsl), so every finder leads to the same path, bit for bit.
class HostFinder final : public PreparedState {
public:
    /// `threads`: 0 for all cores.
    explicit HostFinder(std::uint32_t threads);
    ~HostFinder() override;

    /// Builds the hierarchy of the scene's triangles, or refits it if vertices have moved. `deforming`: build a
    /// hierarchy that can be refitted, even if no vertex has moved yet. `scene` must stay at its address. Needs
    /// GpuScene::topology. Throws Error if memory runs out.
    void bring_up_to_date(const Device& device, const Scene& scene, const GpuScene& gpu_scene, bool deforming = false);
    /// Refits the whole hierarchy, as if every vertex had moved. Serves to measure the time; needs `deforming`.
    void refit();

    /// Triangles in world space, which replace a map of the view.
    const Buffer& triangles() const;
    const Buffer& normals() const;

    /// Finds the candidates of all paths. Paths outside all shells that meet nothing move from their list to `ended`.
    /// If candidates exceed the capacity, their paths get none; the candidates are still counted.
    void find(const PathsOnHost& paths, const CandidatesOnHost& candidates, const PixelListOnHost& ended) const;
    /// Finds the slots that paths are inside of where they start. The first surface of a slot along the ray decides.
    /// For a shell that crosses itself, all of its surfaces along the ray decide.
    void find_media(const PathsOnHost& paths) const;

private:
    struct Hierarchy;
    std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace pellucid
