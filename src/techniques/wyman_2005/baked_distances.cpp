#include "techniques/wyman_2005/baked_distances.h"

#include "bake/bake_cache.h"
#include "bake/inward_distances.h"
#include "bake/sampled_distances.h"
#include "core/math.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace pellucid::wyman_2005 {
namespace {

/// Twin of BakedObject in baked_distances.glsl.
struct BakedObject {
    glm::mat4 baked_from_world;
    glm::vec4 center;  ///< centre of the table's directions, baked frame; w: metres in world space per baked unit
    std::uint32_t first_value;
    std::uint32_t reserved[3];
};
static_assert(sizeof(BakedObject) == 96);

std::string values_name(Distances distances, std::uint32_t side) {
    return distances == Distances::kPerVertex ? "inward distances" : fmt::format("sampled distances {}", side);
}
std::string objects_name(Distances distances, std::uint32_t side) {
    return values_name(distances, side) + " of objects";
}

/// Scale factor of a transform with a uniform scale; otherwise 0.
float uniform_scale(const glm::mat3& linear) {
    const glm::dmat3 m(linear);
    const glm::dmat3 metric = glm::transpose(m) * m;
    const double square = (metric[0][0] + metric[1][1] + metric[2][2]) / 3.0;
    double deviation = 0.0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            deviation = std::max(deviation, std::abs(metric[c][r] - (c == r ? square : 0.0)));
        }
    }
    return deviation <= 1e-5 * square ? float(std::sqrt(square)) : 0.0f;
}

/// Applies the transform to `mesh`, without attributes that baking does not need.
Mesh transformed(const Mesh& mesh, const glm::mat3& linear) {
    Mesh result;
    result.name = mesh.name;
    const glm::mat3 normals = glm::inverseTranspose(linear);
    for (const glm::vec3& p : mesh.positions) result.positions.push_back(linear * p);
    for (const glm::vec3& n : mesh.normals) result.normals.push_back(glm::normalize(normals * n));
    result.triangles = mesh.triangles;
    if (glm::determinant(linear) < 0.0f) {
        for (glm::uvec3& t : result.triangles) std::swap(t.y, t.z);
    }
    return result;
}

/// Fills the values and records of a scene's objects.
class Baking {
public:
    Baking(const Preparation& preparation, Distances distances, std::uint32_t side)
        : preparation_(preparation), distances_(distances), side_(side) {
        std::uint32_t first = 0;
        for (const Mesh& mesh : scene().meshes) {
            first_vertex_.push_back(first);
            first += std::uint32_t(mesh.positions.size());
        }
    }

    void run() {
        std::size_t refracting = 0, done = 0;
        for (const Object& object : scene().objects) refracting += refracts(object) ? 1 : 0;
        for (const Object& object : scene().objects) {
            records_.push_back(BakedObject{});
            if (refracts(object)) bake_object(object, double(done++), double(refracting));
        }
    }
    std::span<const float> values() const { return values_; }
    std::span<const BakedObject> records() const { return records_; }

private:
    const Scene& scene() const { return preparation_.scene; }
    bool refracts(const Object& object) const { return scene().materials[std::size_t(object.material)].refractive(); }

    void bake_object(const Object& object, double done, double all) {
        const Mesh& mesh = scene().meshes[std::size_t(object.mesh)];
        const float scale = uniform_scale(glm::mat3(object.world_from_object));
        const auto progress = [&, done, all](double share) {
            if (preparation_.progress) preparation_.progress((done + share) / all);
        };
        glm::mat4 world_from_baked = object.world_from_object;
        if (scale > 0.0f) {
            const auto [known, is_new] = in_own_frame_.try_emplace(object.mesh, values_.size());
            if (is_new) append(mesh, progress);
            set_record(object, known->second, world_from_baked, scale, mesh);
        } else {
            const Mesh placed = transformed(mesh, glm::mat3(object.world_from_object));
            world_from_baked = glm::translate(glm::mat4(1.0f), glm::vec3(object.world_from_object[3]));
            const std::size_t first = values_.size();
            append(placed, progress);
            set_record(object, first, world_from_baked, 1.0f, placed);
        }
    }

    void append(const Mesh& mesh, const Progress& progress) {
        const std::uint32_t threads = preparation_.threads;
        const std::uint32_t parameters[] = {side_};
        const bool per_vertex = distances_ == Distances::kPerVertex;
        const bake::Quantity quantity =
            per_vertex ? bake::Quantity{"inward-distances", mesh.positions.size()}
                       : bake::Quantity{"sampled-distances", bake::sampled_distance_count(side_), parameters};
        const vk::DeviceSize most = preparation_.device.max_storage_binding() / sizeof(float);
        if (values_.size() + quantity.count > most) {
            throw Error(
                fmt::format("wyman-2005: the baked distances of all solids are more than the {} numbers that {} "
                            "has room for{}",
                            most, preparation_.device.info().name, per_vertex ? "" : "; give a smaller --table"));
        }
        const auto compute = [&] {
            return per_vertex ? bake::inward_distances(mesh, threads, progress)
                              : bake::sampled_distances(mesh, side_, threads, progress);
        };
        const auto baked = preparation_.cache.get(mesh, quantity, compute, preparation_.warnings);
        values_.insert(values_.end(), baked->begin(), baked->end());
    }

    void set_record(const Object& object, std::size_t first, const glm::mat4& world_from_baked, float scale,
                    const Mesh& mesh) {
        BakedObject& record = records_.back();
        record.baked_from_world = glm::inverse(world_from_baked);
        record.center = glm::vec4(bake::mesh_sphere(mesh).center, scale);
        // Shaders index vertices over all meshes. The unsigned difference may wrap around.
        const std::uint32_t skipped =
            distances_ == Distances::kPerVertex ? first_vertex_[std::size_t(object.mesh)] : 0u;
        record.first_value = std::uint32_t(first) - skipped;
    }

    const Preparation& preparation_;
    Distances distances_;
    std::uint32_t side_;
    std::vector<std::uint32_t> first_vertex_;  ///< per mesh, first index in GpuScene::vertices
    std::map<int, std::size_t> in_own_frame_;  ///< mesh index -> index of its first value
    std::vector<float> values_;
    std::vector<BakedObject> records_;
};

template <class T>
Buffer upload_values(const Device& device, const std::string& name, std::span<const T> values) {
    using Usage = vk::BufferUsageFlagBits;
    Buffer buffer(device, name, std::max(values.size_bytes(), sizeof(T)), Usage::eStorageBuffer | Usage::eTransferDst);
    if (!values.empty()) upload(device, buffer, std::as_bytes(values));
    return buffer;
}

}  // namespace

void bake(const Preparation& preparation, Distances distances, std::uint32_t side) {
    auto& prepared = preparation.gpu_scene.prepared;
    const std::string values = values_name(distances, side), objects = objects_name(distances, side);
    if (prepared.contains(values)) return;
    Baking baking(preparation, distances, side);
    baking.run();
    Buffer value_buffer = upload_values(preparation.device, values, baking.values());
    prepared.emplace(objects, upload_values(preparation.device, objects, baking.records()));
    prepared.emplace(values, std::move(value_buffer));
}

BakedDistances baked_distances(const GpuScene& scene, Distances distances, std::uint32_t side) {
    return {scene.prepared.find(values_name(distances, side))->second,
            scene.prepared.find(objects_name(distances, side))->second};
}

}  // namespace pellucid::wyman_2005
