#include "render/cpu_tracing.h"

#include "scene/check_scene.h"
#include "scene/material_textures.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellucid {
namespace {

bool all_finite(std::span<const glm::vec3> values) {
    return std::all_of(values.begin(), values.end(), [](const glm::vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    });
}

void check_moved(const Scene& scene, const MovedMesh& moved) {
    if (moved.mesh < 0 || std::size_t(moved.mesh) >= scene.meshes.size()) {
        throw Error(fmt::format("there is no mesh {} to move; the scene has {}", moved.mesh, scene.meshes.size()));
    }
    const Mesh& mesh = scene.meshes[std::size_t(moved.mesh)];
    const std::string what = fmt::format("mesh {} '{}'", moved.mesh, mesh.name);
    if (moved.positions.size() != mesh.positions.size() || moved.normals.size() != mesh.normals.size()) {
        throw Error(fmt::format("{} has {} positions and {} normals, but was given {} and {}", what,
                                mesh.positions.size(), mesh.normals.size(), moved.positions.size(),
                                moved.normals.size()));
    }
    if (!all_finite(moved.positions)) throw Error(fmt::format("{}: a position is not finite", what));
    if (!all_finite(moved.normals)) throw Error(fmt::format("{}: a normal is not finite", what));
}

}  // namespace

void CpuTracing::set_scene(Scene scene) {
    tracer_.reset();
    scene_ = std::move(scene);
}

void CpuTracing::set_positions(const std::vector<MovedMesh>& moved) {
    for (const MovedMesh& each : moved) check_moved(scene_, each);
    tracer_.reset();
    for (const MovedMesh& each : moved) {
        Mesh& mesh = scene_.meshes[std::size_t(each.mesh)];
        std::copy(each.positions.begin(), each.positions.end(), mesh.positions.begin());
        std::copy(each.normals.begin(), each.normals.end(), mesh.normals.begin());
        mesh.tangents.clear();  // the triangles' texture coordinates say them
    }
}

void CpuTracing::set_transforms(const std::vector<PosedObject>& moved) {
    const std::vector<Object> before = scene_.objects;
    try {
        for (const PosedObject& each : moved) {
            if (each.object < 0 || std::size_t(each.object) >= scene_.objects.size()) {
                throw Error(
                    fmt::format("there is no object {} to move; the scene has {}", each.object, scene_.objects.size()));
            }
            scene_.objects[std::size_t(each.object)].world_from_object = each.world_from_object;
        }
        check_objects(scene_);
    } catch (...) {
        scene_.objects = before;
        throw;
    }
    tracer_.reset();
}

void CpuTracing::set_material(int index, const Material& material) {
    if (index < 0 || std::size_t(index) >= scene_.materials.size())
        throw Error(fmt::format("there is no material {}; the scene has {}", index, scene_.materials.size()));
    Material& own = scene_.materials[std::size_t(index)];
    const auto before_it = textures_of(own), given = textures_of(material);
    if (!std::equal(given.begin(), given.end(), before_it.begin(),
                    [](const Texture* a, const Texture* b) { return a->image == b->image; }))
        throw Error(fmt::format("material {} '{}': its textures cannot be replaced", index, own.name));
    const Material before = std::exchange(own, material);
    try {
        check_materials(scene_);
    } catch (...) {
        own = before;
        throw;
    }
    tracer_.reset();
}

void CpuTracing::set_lights(const std::vector<Light>& lights) {
    tracer_.reset();
    scene_.lights = lights;
}

const Tracer& CpuTracing::tracer() {
    if (!tracer_) tracer_.emplace(scene_, TracerOptions{.threads = threads_});
    return *tracer_;
}

}  // namespace pellucid
