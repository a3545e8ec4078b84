#pragma once

#include "gpu/gpu_scene.h"
#include "layers/pixel_list.h"

#include <cstdint>
#include <memory>
#include <span>

namespace pellucid {

/// Paths that look for the next surface, as path_state.glsl keeps them, in memory that the host shares with the device.
struct PathsOnHost {
    PixelListOnHost list;     ///< those that look
    std::uint32_t width;      ///< of the picture; path `x + width y` is of pixel (x, y)
    const glm::vec4* places;  ///< world, m; w: bits of the triangle on which the path stands
    const glm::vec4* ways;    ///< unit, world
    std::uint32_t* media;     ///< per path `words`, whose bits say what it is inside of, and its mark
    std::uint32_t words;
    float coincidence;  ///< m, by so much places are uncertain
    bool touching;      ///< surfaces of several shells may lie at one place
};

/// A surface that a path may meet; twin of a texel of `candidates` in candidates.glsl.
struct Candidate {
    std::uint32_t triangle, traits;
};
/// Where those of a path lie; twin of a texel of `candidate_lists`.
struct CandidateList {
    std::uint32_t first, count;
};
/// What a finder hands to the device. The first Candidate counts how many there were at most in any search of the frame.
struct CandidatesOnHost {
    CandidateList* lists;  ///< per path
    std::span<Candidate> all;
};

/// Finds the surfaces that paths meet by Embree, on the cores of the host, where that shares its memory with the device:
/// on software drivers.
///
/// It names candidates: the nearest surface that the path can meet and, where others may lie at the same place, those; and
/// where the nearest lies behind the path, within rounding, also the next. The device intersects them itself
/// (candidates.glsl), so a path goes the same way, bit for bit, whoever has found its surfaces.
class HostFinder final : public PreparedState {
public:
    /// `threads` 0: all cores.
    explicit HostFinder(std::uint32_t threads);
    ~HostFinder() override;

    /// Builds the hierarchy of the scene's triangles, or refits it where vertices have moved. `deforming`: as one that can be
    /// refitted, although none have moved yet. `scene` has to stay where it is. Needs GpuScene::topology. Throws Error if
    /// there is not enough memory.
    void bring_up_to_date(const Device& device, const Scene& scene, const GpuScene& gpu_scene, bool deforming = false);
    /// Refits all of a hierarchy that can be refitted, as if every vertex had moved: to measure what that takes.
    void refit();

    /// What stands for a map of the view: its triangles alone, in the world.
    const Buffer& triangles() const;
    const Buffer& normals() const;

    /// Finds candidates of all paths. Those that are in the open and meet nothing go from their list to `ended`. Where there
    /// is no room for candidates, a path has none, and they are counted.
    void find(const PathsOnHost& paths, const CandidatesOnHost& candidates, const PixelListOnHost& ended) const;
    /// Finds what paths are inside of where they start: the first surface of each slot on their way says it; of a shell
    /// that crosses itself, all of its surfaces.
    void find_media(const PathsOnHost& paths) const;

private:
    struct Hierarchy;
    std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace pellucid
