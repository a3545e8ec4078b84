#pragma once

#include "gpu/counted_buffer.h"
#include "gpu/frame.h"
#include "layers/surface_map.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

struct MapRecord;

/// Surface maps of every mesh that an object shows, in the mesh's own frame. A mesh has one map along each axis; their
/// square texels have the same width. Objects that share a mesh share its maps. Maps are kept until the mesh moves.
///
/// Every map holds all surfaces, so one would suffice. A ray walks the map along the axis nearest to its direction,
/// where it passes the fewest texels.
class MeshMaps {
public:
    MeshMaps();

    static constexpr std::uint32_t kAxes = 3;

    /// Records the building of maps of meshes that are new or have moved since the last call. `resolution`: texels
    /// along the longest side of each mesh's box. Meshes with many triangles get more texels; all get fewer if memory
    /// is short. Throws Error if the device does not have the memory for the coarsest maps.
    SurfaceMap bring_up_to_date(Recorder& recorder, const Frame& frame, std::uint32_t resolution);
    /// Call after the frame has run. True if data exceeded a capacity; then the frame must be recorded again.
    bool must_repeat();
    /// Indices of the meshes whose maps the current frame builds.
    const std::vector<std::uint32_t>& building() const { return building_; }

private:
    /// Ranges of a map in the buffers, as first item and capacity.
    struct Place {
        std::uint64_t first_texel = 0, texels = 0;
        std::uint64_t first_node = 0, nodes = 0;
        std::uint64_t first_record = 0, records = 0;  ///< records = 0: automatic
        std::uint64_t counted = 0;                    ///< records that the map needed in the frame that has run
    };
    struct Mapped {
        bool shown = false;  ///< by an object
        bool built = false;
        std::uint64_t moves = 0;  ///< GpuMesh::moves when the maps were built
        Place places[kAxes];
    };

    /// Capacities that all maps need together. `found`: the need of the largest map.
    struct Room {
        std::uint64_t texels = 0, nodes = 0, records = 0, found = 0;
    };

    bool fits(const Frame& frame) const;
    Room place_maps(const GpuScene& scene);
    void lay_out(const Frame& frame);
    std::vector<MapRecord> write_tables(Recorder& recorder, const Frame& frame);
    SurfaceMap buffers() const;

    std::uint32_t texels_across(const GpuMesh& mesh) const;  ///< along the longest side of its box
    std::uint32_t resolution_ = 0;                           ///< requested
    std::uint32_t texels_across_ = 0;                        ///< resolution that fits into memory
    std::vector<Mapped> meshes_;
    std::vector<std::uint32_t> building_;  ///< meshes whose maps the current frame builds
    CountedBuffer found_, tiles_;          ///< scratch memory while a map is built
    bool laid_out_ = false;
    Buffer maps_, objects_, triangles_, normals_, texels_, ranges_, records_, pyramid_;
};

}  // namespace pellucid
