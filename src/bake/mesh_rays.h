#pragma once

#include <pellucid/scene.h>

#include <embree3/rtcore.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace pellucid::bake {

/// Intersection of rays with the triangles of one mesh, in its own frame.
///
/// A ray that starts on the surface ignores the triangles at its start. The mesh's adjacency identifies them, so no
/// least distance is needed. A ray searches for a crossing in one sense, out of the solid or into it. It ignores
/// triangles that it crosses in the other sense.
class MeshRays {
public:
    /// `mesh` must be checked and outlive this object. `threads`: 0 for all cores. Throws Error if Embree cannot build.
    MeshRays(const Mesh& mesh, std::uint32_t threads);

    struct Hit {
        float distance;          ///< m
        std::uint32_t triangle;  ///< Mesh::triangles
        glm::vec3 position;      ///< on the triangle
    };
    /// The point where a ray from a vertex leaves the solid. `direction`: unit. Triangles at the vertex are ignored.
    std::optional<Hit> leave_from_vertex(std::uint32_t vertex, const glm::vec3& direction) const;
    /// The point where a ray from a point on a triangle leaves the solid.
    std::optional<Hit> leave_from_triangle(const glm::vec3& point, std::uint32_t triangle,
                                           const glm::vec3& direction) const;
    /// The first point where a ray from outside enters the solid.
    std::optional<Hit> enter(const glm::vec3& point, const glm::vec3& direction) const;

    /// True if a ray along `direction` enters the solid through the triangle.
    bool enters(std::uint32_t triangle, const glm::vec3& direction) const;

private:
    struct Query;
    std::optional<Hit> trace(const glm::vec3& origin, const glm::vec3& direction, const Query& query) const;
    static void filter(const RTCFilterFunctionNArguments* arguments);

    template <auto kRelease>
    struct Release {
        template <class Handle>
        void operator()(Handle handle) const {
            kRelease(handle);
        }
    };
    const Mesh& mesh_;
    std::vector<glm::vec3> positions_;  ///< of the mesh, and one extra for Embree
    std::vector<std::uint32_t> weld_;   ///< per vertex, the first vertex at the same position
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release<rtcReleaseDevice>> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release<rtcReleaseScene>> scene_;
};

}  // namespace pellucid::bake
