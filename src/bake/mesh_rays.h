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

/// Rays through the triangles of one mesh, in its own frame.
///
/// A ray that starts on the surface does not meet the triangles that it starts on: they are told by the mesh's
/// adjacency, so that no distance has to be kept from them. What it looks for is a crossing in one sense, out of
/// the solid or into it; triangles crossed the other way are passed through.
class MeshRays {
public:
    /// `mesh` must be checked and outlive this. Throws Error if Embree cannot build. `threads` 0: all cores.
    MeshRays(const Mesh& mesh, std::uint32_t threads);

    struct Hit {
        float distance;          ///< m
        std::uint32_t triangle;  ///< Mesh::triangles
        glm::vec3 position;      ///< on the triangle
    };
    /// From a vertex into the solid, `direction` unit: where the ray leaves it, past the triangles around the vertex.
    std::optional<Hit> leave_from_vertex(std::uint32_t vertex, const glm::vec3& direction) const;
    /// The same from a point on a triangle.
    std::optional<Hit> leave_from_triangle(const glm::vec3& point, std::uint32_t triangle,
                                           const glm::vec3& direction) const;
    /// From a point outside: the first triangle that the ray enters the solid by.
    std::optional<Hit> enter(const glm::vec3& point, const glm::vec3& direction) const;

    /// True if `direction` runs into the solid where it crosses the triangle.
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
    std::vector<glm::vec3> positions_;  ///< one more than the mesh has
    std::vector<std::uint32_t> weld_;   ///< per vertex, the first at the same place
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release<rtcReleaseDevice>> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release<rtcReleaseScene>> scene_;
};

}  // namespace pellucid::bake
