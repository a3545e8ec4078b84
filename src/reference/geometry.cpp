// Building and moving the triangles; the search is in geometry_search.cpp.
#include "reference/geometry.h"

#include "core/math.h"
#include "scene/mesh_repair.h"

#include <pellucid/error.h>

#include <tbb/task_arena.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>

namespace pellucid::reference {
namespace {

SurfaceKind kind_of(const Material& material) {
    if (material.refractive()) return SurfaceKind::kRefractive;
    return material.transmissive() ? SurfaceKind::kThin : SurfaceKind::kOpaque;
}

RTCBuildQuality embree_quality(BuildQuality quality) {
    constexpr std::array kQualities{RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH};
    return kQualities[std::size_t(quality)];
}

void check_embree(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    throw Error(fmt::format(
        "Embree cannot build the hierarchy of the scene's triangles: {}",
        code == RTC_ERROR_OUT_OF_MEMORY ? std::string("out of memory") : fmt::format("error {}", int(code))));
}

bool boxes_meet(const glm::dvec3& low_a, const glm::dvec3& high_a, const glm::dvec3& low_b, const glm::dvec3& high_b) {
    return glm::all(glm::lessThanEqual(low_a, high_b)) && glm::all(glm::lessThanEqual(low_b, high_a));
}

double volume(const glm::dvec3& low, const glm::dvec3& high) {
    const glm::dvec3 size = high - low;
    return size.x * size.y * size.z;
}

}  // namespace

Geometry::Geometry(const Scene& scene, const TracerOptions& options)
    : scene_(scene), options_(options), objects_(scene.objects.size()), solids_(scene.objects.size()) {
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) throw Error(fmt::format("Embree cannot start: error {}", int(rtcGetDeviceError(nullptr))));
    embree_.reset(rtcNewScene(device_.get()));
    const unsigned flags = unsigned(RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION) |
                           (options.robust ? unsigned(RTC_SCENE_FLAG_ROBUST) : 0u) |
                           (options.deforming ? unsigned(RTC_SCENE_FLAG_DYNAMIC) : 0u);
    rtcSetSceneFlags(embree_.get(), RTCSceneFlags(flags));
    // Only in a scene of low quality does Embree keep a hierarchy per object, which it can refit; the
    // quality of each is then its own.
    rtcSetSceneBuildQuality(embree_.get(), options.deforming ? RTC_BUILD_QUALITY_LOW : embree_quality(options.quality));

    std::vector<char> closed;
    for (const Mesh& each : scene.meshes) {
        welds_.push_back(weld_positions(each.positions));
        closed.push_back(count_edges(each.triangles, welds_.back()).closed());
    }
    for (std::uint32_t i = 0; i < object_count(); ++i) {
        const Material& m = material(i);
        objects_[i].kind = kind_of(m);
        objects_[i].has_holes = objects_[i].kind != SurfaceKind::kRefractive && m.alpha_cutoff > 0.0f;
        objects_[i].mirrored = glm::determinant(glm::dmat3(scene.objects[i].world_from_object)) < 0.0;
        solids_[i].medium = {channel_iors(double(m.ior), double(m.dispersion)), glm::dvec3(m.sigma_a())};
        solids_[i].closed = closed[std::size_t(scene.objects[i].mesh)] != 0;
        place(i, mesh(i).positions, mesh(i).normals);
        attach(i);
    }
    commit();
}

const Mesh& Geometry::mesh(std::uint32_t object) const {
    return scene_.meshes[std::size_t(scene_.objects[object].mesh)];
}

const Material& Geometry::material(std::uint32_t object) const {
    return scene_.materials[std::size_t(scene_.objects[object].material)];
}

/// Takes vertices of an object to world space.
void Geometry::place(std::uint32_t object, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals) {
    const glm::dmat4 world_from_object(scene_.objects[object].world_from_object);
    const glm::dmat3 normal_matrix = glm::inverseTranspose(glm::dmat3(world_from_object));
    Object& o = objects_[object];
    o.positions.resize(positions.size() + 1);  // Embree reads 16 bytes at the last vertex
    o.low = glm::dvec3(std::numeric_limits<double>::infinity());
    o.high = -o.low;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const glm::vec3 p(world_from_object * glm::dvec4(positions[i], 1.0));
        o.positions[i] = p;
        o.low = glm::min(o.low, glm::dvec3(p));
        o.high = glm::max(o.high, glm::dvec3(p));
    }
    std::vector<glm::vec3> world_normals;
    world_normals.reserve(normals.size());
    for (const glm::vec3& n : normals) {
        world_normals.emplace_back(glm::normalize(normal_matrix * glm::dvec3(n)));
    }
    const std::vector<std::uint32_t>& weld = welds_[std::size_t(scene_.objects[object].mesh)];
    const std::vector<glm::uvec3>& triangles = mesh(object).triangles;
    o.facets.resize(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3 t = triangles[i];
        o.facets[i] = {{o.positions[t.x], o.positions[t.y], o.positions[t.z]},
                       {world_normals[t.x], world_normals[t.y], world_normals[t.z]},
                       {weld[t.x], weld[t.y], weld[t.z]}};
    }
}

void Geometry::attach(std::uint32_t object) {
    Object& o = objects_[object];
    const std::vector<glm::uvec3>& triangles = mesh(object).triangles;
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, o.positions.data(), 0,
                               sizeof(glm::vec3), o.positions.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                               sizeof(glm::uvec3), triangles.size());
    rtcSetGeometryBuildQuality(geometry, embree_quality(options_.quality));
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree_.get(), geometry, object);
    rtcReleaseGeometry(geometry);
}

void Geometry::rank_solids() {
    std::vector<std::uint32_t> order(objects_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return volume(objects_[a].low, objects_[a].high) > volume(objects_[b].low, objects_[b].high);
    });
    for (std::uint32_t rank = 0; rank < order.size(); ++rank) solids_[order[rank]].precedence = rank;
}

/// Sweeps along x over the boxes in the order of their low ends.
void Geometry::find_touching() {
    std::vector<Object*> order;
    for (Object& o : objects_) {
        o.touches = false;
        order.push_back(&o);
    }
    std::sort(order.begin(), order.end(), [](const Object* a, const Object* b) { return a->low.x < b->low.x; });
    const glm::dvec3 apart(coincidence());
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = i + 1; k < order.size() && order[k]->low.x <= order[i]->high.x + apart.x; ++k) {
            if (!boxes_meet(order[i]->low - apart, order[i]->high + apart, order[k]->low, order[k]->high)) continue;
            order[i]->touches = order[k]->touches = true;
        }
    }
}

void Geometry::commit() {
    const auto start = std::chrono::steady_clock::now();
    // Embree's own setting for the number of threads would bind the whole process.
    tbb::task_arena arena(options_.threads > 0 ? int(options_.threads) : tbb::task_arena::automatic);
    arena.execute([&] { rtcJoinCommitScene(embree_.get()); });
    build_ms_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    check_embree(device_.get());
    scale_ = 0.0;
    for (const Object& o : objects_) {
        const glm::dvec3 far = glm::max(glm::abs(o.low), glm::abs(o.high));
        scale_ = std::max({scale_, far.x, far.y, far.z});
    }
    rank_solids();
    find_touching();
}

bool Geometry::in_air(const glm::dvec3& low, const glm::dvec3& high) const {
    return std::none_of(objects_.begin(), objects_.end(), [&](const Object& o) {
        return o.kind == SurfaceKind::kRefractive && boxes_meet(o.low, o.high, low, high);
    });
}

void Geometry::check_moved(const MovedMesh& moved) const {
    if (moved.mesh < 0 || std::size_t(moved.mesh) >= scene_.meshes.size()) {
        throw Error(fmt::format("there is no mesh {} to move; the scene has {}", moved.mesh, scene_.meshes.size()));
    }
    const Mesh& m = scene_.meshes[std::size_t(moved.mesh)];
    if (moved.positions.size() != m.positions.size() || moved.normals.size() != m.normals.size()) {
        throw Error(fmt::format("mesh {} '{}' has {} positions and {} normals, but was given {} and {}", moved.mesh,
                                m.name, m.positions.size(), m.normals.size(), moved.positions.size(),
                                moved.normals.size()));
    }
}

void Geometry::update(std::span<const MovedMesh> moved, Tracer::Update update) {
    for (const MovedMesh& each : moved) check_moved(each);
    const bool refit = update == Tracer::Update::kRefit;
    if (refit && !options_.deforming) {
        throw Error("a hierarchy can only be refitted if it was built with TracerOptions::deforming");
    }
    for (const MovedMesh& each : moved) {
        for (std::uint32_t i = 0; i < object_count(); ++i) {
            if (scene_.objects[i].mesh != each.mesh) continue;
            place(i, each.positions, each.normals);
            const RTCGeometry geometry = rtcGetGeometry(embree_.get(), i);
            rtcSetGeometryBuildQuality(geometry, refit ? RTC_BUILD_QUALITY_REFIT : embree_quality(options_.quality));
            rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
            rtcCommitGeometry(geometry);
        }
    }
    commit();
}

}  // namespace pellucid::reference
