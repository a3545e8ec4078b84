// Building and moving the triangles; the search is in geometry_search.cpp.
#include "reference/geometry.h"

#include "core/math.h"
#include "scene/bodies.h"
#include "scene/mesh_repair.h"

#include <pellucid/error.h>

#include <tbb/task_arena.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

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

}  // namespace

Geometry::Geometry(const Scene& scene, const TracerOptions& options)
    : scene_(scene), options_(options), objects_(scene.objects.size()) {
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

    for (std::uint32_t i = 0; i < object_count(); ++i) {
        const Material& m = material(i);
        objects_[i].kind = kind_of(m);
        objects_[i].has_holes = objects_[i].kind != SurfaceKind::kRefractive && m.has_holes();
        objects_[i].single_sided = m.single_sided();
        objects_[i].mirrored = glm::determinant(glm::dmat3(scene.objects[i].world_from_object)) < 0.0;
        objects_[i].facets.resize(mesh(i).triangles.size());
    }
    number_shells();
    for (std::uint32_t i = 0; i < object_count(); ++i) {
        place(i, mesh(i).positions, mesh(i).normals);
        attach(i);
    }
    commit();
}

const Mesh& Geometry::mesh(std::uint32_t object) const {
    return scene_.meshes[std::size_t(scene_.objects[object].mesh)];
}

Hit Geometry::at(std::uint32_t object, std::uint32_t triangle, double u, double v) const {
    const Corners c = corners(object, triangle);
    Hit hit;
    hit.found = true;
    hit.crossing = {object, triangle, Sense::kEntering, shell(object, triangle)};
    hit.normal = c.normal;
    hit.u = u;
    hit.v = v;
    hit.position = (1.0 - u - v) * c.p0 + u * c.p1 + v * c.p2;
    return hit;
}

const Material& Geometry::material(std::uint32_t object) const {
    return scene_.materials[std::size_t(scene_.objects[object].material)];
}

/// What vertices that move leave as it is: bodies, their shells, and who displaces whom.
void Geometry::number_shells() {
    const Bodies bodies = find_bodies(scene_);
    const auto count = std::uint32_t(bodies.all.size());
    for (const Body& body : bodies.all) {
        const Material& m = scene_.materials[body.material];
        const Medium medium{channel_iors(double(m.ior), double(m.dispersion)), glm::dvec3(m.sigma_a())};
        const auto closed = std::uint32_t(solids_.size());
        solids_.push_back({medium, count + body.rank, true});
        solids_.push_back({medium, body.rank, false});
        const auto first = std::uint32_t(shells_.size()), number = std::uint32_t(extents_.size());
        const BodySurface& surface = *body.surface;
        for (const char is_closed : surface.shells.closed)
            shells_.push_back({.solid = is_closed != 0 ? closed : closed + 1, .body = number});
        extents_.push_back(0.0);
        for (std::size_t k = 0; k < body.objects.size(); ++k) {
            const std::vector<glm::uvec3>& triangles = mesh(body.objects[k]).triangles;
            for (std::size_t t = 0; t < triangles.size(); ++t) {
                Facet& facet = objects_[body.objects[k]].facets[t];
                for (int c = 0; c < 3; ++c) facet.vertices[c] = surface.weld[surface.first_vertex[k] + triangles[t][c]];
                facet.shell = first + surface.shells.of_triangle[surface.first_triangle[k] + t];
            }
        }
    }
    std::vector<std::vector<std::uint32_t>> welds(scene_.meshes.size());
    for (std::uint32_t i = 0; i < object_count(); ++i) {
        if (bodies.of_object[i] != kNoBody) continue;
        std::vector<std::uint32_t>& weld = welds[std::size_t(scene_.objects[i].mesh)];
        if (weld.empty()) weld = weld_positions(mesh(i).positions);
        const auto shell = std::uint32_t(shells_.size());
        shells_.push_back({.body = std::uint32_t(extents_.size())});
        extents_.push_back(0.0);
        for (std::size_t t = 0; t < objects_[i].facets.size(); ++t) {
            const glm::uvec3 corners = mesh(i).triangles[t];
            objects_[i].facets[t].vertices = {weld[corners.x], weld[corners.y], weld[corners.z]};
            objects_[i].facets[t].shell = shell;
        }
    }
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
    const std::vector<glm::uvec3>& triangles = mesh(object).triangles;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const glm::uvec3 t = triangles[i];
        o.facets[i].corners = {o.positions[t.x], o.positions[t.y], o.positions[t.z]};
        o.facets[i].normals = {world_normals[t.x], world_normals[t.y], world_normals[t.z]};
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

void Geometry::measure_shells() {
    const glm::dvec3 nowhere(std::numeric_limits<double>::infinity());
    for (ShellRecord& shell : shells_) shell.low = nowhere, shell.high = -nowhere;
    for (const Object& o : objects_) {
        for (const Facet& facet : o.facets) {
            ShellRecord& shell = shells_[facet.shell];
            for (const glm::vec3& corner : facet.corners) {
                shell.low = glm::min(shell.low, glm::dvec3(corner));
                shell.high = glm::max(shell.high, glm::dvec3(corner));
            }
        }
    }
    std::vector<std::pair<glm::dvec3, glm::dvec3>> boxes(extents_.size(), {nowhere, -nowhere});
    for (const ShellRecord& shell : shells_) {
        auto& [low, high] = boxes[shell.body];
        low = glm::min(low, shell.low);
        high = glm::max(high, shell.high);
    }
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        const glm::dvec3 size = boxes[b].second - boxes[b].first;
        extents_[b] = std::max({size.x, size.y, size.z, 0.0});
    }
}

/// Sweeps along x over the boxes in the order of their low ends.
void Geometry::find_touching() {
    widest_contact_ = 4.0 * 0x1p-23 * scale_;
    for (const double extent : extents_) widest_contact_ = std::max(widest_contact_, kContact * extent);
    const double apart = widest_contact_;
    std::vector<ShellRecord*> order;
    for (ShellRecord& shell : shells_) {
        shell.touches = false;
        order.push_back(&shell);
    }
    std::sort(order.begin(), order.end(),
              [](const ShellRecord* a, const ShellRecord* b) { return a->low.x < b->low.x; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = i + 1; k < order.size() && order[k]->low.x <= order[i]->high.x + apart; ++k) {
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
    measure_shells();
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
            objects_[i].has_moved = true;
            const RTCGeometry geometry = rtcGetGeometry(embree_.get(), i);
            rtcSetGeometryBuildQuality(geometry, refit ? RTC_BUILD_QUALITY_REFIT : embree_quality(options_.quality));
            rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
            rtcCommitGeometry(geometry);
        }
    }
    commit();
}

}  // namespace pellucid::reference
