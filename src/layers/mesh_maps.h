#pragma once

#include "gpu/counted_buffer.h"
#include "gpu/frame.h"
#include "layers/surface_map.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace pellucid {

struct MapRecord;

/// Surface maps of every mesh that an object shows: in the mesh's own frame, along each of its axes, in square texels
/// that are as wide in all three. Objects that share a mesh share its maps, and they are kept until the mesh moves.
///
/// As every surface is in the map along any axis, one would do. A ray walks the one along the axis nearest to its own,
/// in which it passes the fewest texels.
class MeshMaps {
public:
    MeshMaps();

    static constexpr std::uint32_t kAxes = 3;

    /// Builds the maps of meshes that are new or have moved since the last call, within the frame. `resolution`:
    /// texels along the longest side of each mesh's box, more where it has many triangles; fewer where the device has no
    /// room for them. Throws Error if it has none even for coarse ones.
    SurfaceMap bring_up_to_date(Recorder& recorder, const Frame& frame, std::uint32_t resolution);
    /// After the frame has run: true if something did not fit; then the frame must be recorded again.
    bool must_repeat();
    /// The meshes whose maps the frame that is being recorded builds.
    const std::vector<std::uint32_t>& building() const { return building_; }

private:
    /// Where a map lies in the buffers, and how much room is there.
    struct Place {
        std::uint64_t first_texel = 0, texels = 0;
        std::uint64_t first_node = 0, nodes = 0;
        std::uint64_t first_record = 0, records = 0;  ///< records 0: choose
        std::uint64_t counted = 0;                    ///< records that it needs, of the frame that has run
    };
    struct Mapped {
        bool shown = false;  ///< by an object
        bool built = false;
        std::uint64_t moves = 0;  ///< GpuMesh::moves that the maps are of
        Place places[kAxes];
    };

    /// What all maps need together, and `found` the largest.
    struct Room {
        std::uint64_t texels = 0, nodes = 0, records = 0, found = 0;
    };

    bool fits(const Frame& frame) const;
    Room place_maps(const GpuScene& scene);
    void lay_out(const Frame& frame);
    std::vector<MapRecord> write_tables(Recorder& recorder, const Frame& frame);
    SurfaceMap buffers() const;

    std::uint32_t texels_across(const GpuMesh& mesh) const;  ///< along the longest side of its box
    std::uint32_t resolution_ = 0;                           ///< asked for,
    std::uint32_t texels_across_ = 0;                        ///< and what there is room for
    std::vector<Mapped> meshes_;
    std::vector<std::uint32_t> building_;  ///< meshes, in the frame that is being recorded
    CountedBuffer found_, tiles_;          ///< while a map is built
    bool laid_out_ = false;
    Buffer maps_, objects_, triangles_, normals_, texels_, ranges_, records_, pyramid_;
};

}  // namespace pellucid
