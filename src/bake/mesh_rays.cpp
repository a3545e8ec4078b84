#include "bake/mesh_rays.h"

#include "scene/mesh_repair.h"

#include <pellucid/error.h>

#include <tbb/task_arena.h>

#include <fmt/format.h>

#include <limits>

namespace pellucid::bake {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

}  // namespace

/// The triangles that a ray may meet.
struct MeshRays::Query {
    RTCIntersectContext embree{};  // the first member, because Embree passes its address to filter()
    const MeshRays* rays = nullptr;
    bool leaving = true;
    std::uint32_t triangle = kNone;  ///< on which the ray starts
    std::uint32_t vertex = kNone;    ///< welded, at which the ray starts
};

MeshRays::MeshRays(const Mesh& mesh, std::uint32_t threads)
    : mesh_(mesh), positions_(mesh.positions), weld_(weld_positions(mesh.positions)) {
    positions_.emplace_back(0.0f);  // Embree reads 16 bytes at the last vertex
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) throw Error(fmt::format("Embree cannot start: error {}", int(rtcGetDeviceError(nullptr))));
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(),
                     RTCSceneFlags(unsigned(RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION) | unsigned(RTC_SCENE_FLAG_ROBUST)));
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                               sizeof(glm::vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(glm::uvec3), mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_.get(), geometry, 0);
    rtcReleaseGeometry(geometry);
    tbb::task_arena arena(threads > 0 ? int(threads) : tbb::task_arena::automatic);
    arena.execute([&] { rtcJoinCommitScene(scene_.get()); });
    if (const RTCError code = rtcGetDeviceError(device_.get()); code != RTC_ERROR_NONE) {
        throw Error(fmt::format("Embree cannot build the hierarchy of mesh '{}': error {}", mesh.name, int(code)));
    }
}

bool MeshRays::enters(std::uint32_t triangle, const glm::vec3& direction) const {
    const glm::uvec3 t = mesh_.triangles[triangle];
    const glm::dvec3 a(positions_[t.x]), b(positions_[t.y]), c(positions_[t.z]);
    return glm::dot(glm::cross(b - a, c - a), glm::dvec3(direction)) < 0.0;
}

void MeshRays::filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& query = *reinterpret_cast<const Query*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const glm::uvec3 corners = query.rays->mesh_.triangles[triangle];
        const auto at_start = [&](std::uint32_t corner) { return query.rays->weld_[corner] == query.vertex; };
        const glm::vec3 direction(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_y(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_z(arguments->ray, arguments->N, i));
        if (triangle == query.triangle || at_start(corners.x) || at_start(corners.y) || at_start(corners.z) ||
            query.rays->enters(triangle, direction) == query.leaving) {
            arguments->valid[i] = 0;
        }
    }
}

std::optional<MeshRays::Hit> MeshRays::trace(const glm::vec3& origin, const glm::vec3& direction,
                                             const Query& query) const {
    Query context = query;
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = filter;
    context.rays = this;
    RTCRayHit ray_hit{};
    ray_hit.ray.org_x = origin.x;
    ray_hit.ray.org_y = origin.y;
    ray_hit.ray.org_z = origin.z;
    ray_hit.ray.dir_x = direction.x;
    ray_hit.ray.dir_y = direction.y;
    ray_hit.ray.dir_z = direction.z;
    ray_hit.ray.tfar = std::numeric_limits<float>::infinity();
    ray_hit.ray.mask = ~0u;
    ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_.get(), &context.embree, &ray_hit);
    if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::uvec3 t = mesh_.triangles[ray_hit.hit.primID];
    const float u = ray_hit.hit.u, v = ray_hit.hit.v;
    return Hit{ray_hit.ray.tfar, ray_hit.hit.primID,
               (1.0f - u - v) * positions_[t.x] + u * positions_[t.y] + v * positions_[t.z]};
}

std::optional<MeshRays::Hit> MeshRays::leave_from_vertex(std::uint32_t vertex, const glm::vec3& direction) const {
    Query query;
    query.vertex = weld_[vertex];
    if (const auto hit = trace(positions_[vertex], direction, query)) return hit;
    // On symmetric meshes a ray may pass exactly through another vertex, where rounding can make it miss all triangles.
    // Float directions have an error of about 2^-24, so retry with directions that differ by a few units of 2^-23.
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 beside((i & 1) ? 1.0f : -1.0f, (i & 2) ? 1.0f : -1.0f, (i & 4) ? 1.0f : -1.0f);
        const glm::vec3 nearly = glm::normalize(direction + 4.0f * 0x1p-23f * beside);
        if (const auto hit = trace(positions_[vertex], nearly, query)) return hit;
    }
    return std::nullopt;
}

std::optional<MeshRays::Hit> MeshRays::leave_from_triangle(const glm::vec3& point, std::uint32_t triangle,
                                                           const glm::vec3& direction) const {
    Query query;
    query.triangle = triangle;
    return trace(point, direction, query);
}

std::optional<MeshRays::Hit> MeshRays::enter(const glm::vec3& point, const glm::vec3& direction) const {
    Query query;
    query.leaving = false;
    return trace(point, direction, query);
}

}  // namespace pellucid::bake
