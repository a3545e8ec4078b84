#include "render/local_thickness.h"

#include "bake/inverted_occlusion.h"
#include "core/math.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <span>
#include <utility>

namespace pellucid {
namespace {

constexpr std::uint32_t kRays = 64;  // rays per vertex; the mean chord of a ball is then accurate to 0.1%

/// Twin of an element of LocalObjects in transmit_light.comp.
struct LocalObject {
    std::uint32_t first_value;
    float scale;
};
static_assert(sizeof(LocalObject) == 8);

/// Metres in world space per unit of the mesh; 0 if the scale is not uniform.
float uniform_scale(const glm::mat3& linear) {
    const glm::dmat3 m(linear), metric = glm::transpose(m) * m;
    const double square = (metric[0][0] + metric[1][1] + metric[2][2]) / 3.0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            if (std::abs(metric[c][r] - (c == r ? square : 0.0)) > 1e-5 * square) return 0.0f;
        }
    }
    return float(std::sqrt(square));
}

Mesh as_it_stands(const Mesh& mesh, const glm::mat3& linear) {
    Mesh placed;
    placed.name = mesh.name;
    placed.triangles = mesh.triangles;
    const glm::mat3 normals = glm::inverseTranspose(linear);
    for (const glm::vec3& p : mesh.positions) placed.positions.push_back(linear * p);
    for (const glm::vec3& n : mesh.normals) placed.normals.push_back(glm::normalize(normals * n));
    if (glm::determinant(linear) < 0.0f) {
        for (glm::uvec3& t : placed.triangles) std::swap(t.y, t.z);
    }
    return placed;
}

template <class T>
Buffer uploaded(const Device& device, const char* name, const std::vector<T>& data) {
    Buffer buffer(device, name, std::max<std::size_t>(data.size(), 1) * sizeof(T),
                  vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst);
    if (!data.empty()) upload(device, buffer, std::as_bytes(std::span(data)));
    return buffer;
}

}  // namespace

LocalThickness bake_local_thickness(const Device& device, const Scene& scene, ThicknessMethod method,
                                    bake::BakeCache& cache, std::uint32_t threads, const Progress& progress,
                                    std::vector<std::string>& warnings) {
    std::vector<std::uint32_t> first_vertex;  // per mesh
    std::uint32_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) {
        first_vertex.push_back(vertices);
        vertices += std::uint32_t(mesh.positions.size());
    }
    std::vector<float> values;
    std::vector<LocalObject> objects(scene.objects.size(), LocalObject{});
    std::map<int, std::size_t> in_own_frame;  // mesh index -> index of its first value
    const std::uint32_t parameters[] = {kRays};
    const bool published = method == ThicknessMethod::kPublishedLocalThickness;
    const auto values_of = published ? bake::inside_share : bake::inverted_occlusion;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (!scene.materials[std::size_t(object.material)].translucent()) continue;
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        const glm::mat3 linear(object.world_from_object);
        const float scale = uniform_scale(linear);
        std::size_t first = values.size();
        const auto known = in_own_frame.find(object.mesh);
        if (scale > 0.0f && known != in_own_frame.end()) {
            first = known->second;
        } else {
            const Mesh baked = scale > 0.0f ? mesh : as_it_stands(mesh, linear);
            const auto share = [&, i](double done) {
                if (progress) progress((double(i) + done) / double(scene.objects.size()));
            };
            const auto found = cache.get(
                baked, {published ? "inside-share" : "inverted-occlusion", baked.positions.size(), parameters},
                [&] { return values_of(baked, kRays, threads, share); }, warnings);
            values.insert(values.end(), found->begin(), found->end());
            if (scale > 0.0f) in_own_frame[object.mesh] = first;
        }
        // Shaders index vertices over all meshes. The unsigned difference may wrap around.
        objects[i] = {std::uint32_t(first) - first_vertex[std::size_t(object.mesh)], scale > 0.0f ? scale : 1.0f};
    }
    return {uploaded(device, "local thickness", values), uploaded(device, "objects of local thickness", objects)};
}

}  // namespace pellucid
