#include "gpu/gpu_scene.h"

#include "gpu/emitters.h"
#include "gpu/material_records.h"
#include "gpu/punctual_light.h"

#include "gpu/texture_pages.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace pellucid {
namespace {

struct Vertex {
    glm::vec3 position;
    glm::vec3 normal;
};
static_assert(sizeof(Vertex) == kVertexStride);

struct Appearance {
    glm::vec2 texcoord[2];
    std::uint32_t color;
};
static_assert(sizeof(Appearance) == 20);

std::uint32_t pack_color(glm::vec4 color) {
    const glm::uvec4 c(glm::clamp(color, 0.0f, 1.0f) * 255.0f + 0.5f);
    return c.r | c.g << 8 | c.b << 16 | c.a << 24;
}

template <class T>
Buffer upload_buffer(const Device& device, const char* name, const std::vector<T>& data, vk::BufferUsageFlags usage) {
    Buffer buffer(device, name, data.size() * sizeof(T), usage | vk::BufferUsageFlagBits::eTransferDst);
    upload(device, buffer, std::as_bytes(std::span(data)));
    return buffer;
}

/// As the frames after this see it. The buffer is made anew where its size differs.
template <class T>
void write_buffer(const Device& device, Buffer& buffer, const char* name, const std::vector<T>& data) {
    const std::span<const std::byte> bytes = std::as_bytes(std::span(data));
    if (buffer.size() != bytes.size())
        buffer = Buffer(device, name, bytes.size(),
                        vk::BufferUsageFlagBits::eStorageBuffer | vk::BufferUsageFlagBits::eTransferDst);
    upload_later(device, buffer, bytes);
}

/// Vertices and triangles of every mesh, one after the other.
struct Geometry {
    std::vector<std::uint32_t> indices;
    std::vector<Vertex> vertices;
    std::vector<Appearance> appearance;
    std::vector<std::uint32_t> first_corner;  // per mesh, in `indices`
};

std::vector<Vertex> vertices_of(const Mesh& mesh) {
    std::vector<Vertex> vertices(mesh.positions.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = {mesh.positions[v], mesh.normals[v]};
    return vertices;
}

std::pair<glm::vec3, glm::vec3> box_of(const Mesh& mesh) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {low, high};
}

void append(Geometry& geometry, const Mesh& mesh) {
    const auto first_vertex = std::uint32_t(geometry.vertices.size());
    geometry.first_corner.push_back(std::uint32_t(geometry.indices.size()));
    const std::vector<Vertex> vertices = vertices_of(mesh);
    geometry.vertices.insert(geometry.vertices.end(), vertices.begin(), vertices.end());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        Appearance look{};
        for (int set = 0; set < 2; ++set) {
            if (!mesh.texcoords[set].empty()) look.texcoord[set] = mesh.texcoords[set][v];
        }
        look.color = mesh.colors.empty() ? ~0u : pack_color(mesh.colors[v]);
        geometry.appearance.push_back(look);
    }
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) geometry.indices.push_back(first_vertex + triangle[corner]);
    }
}

Geometry join_meshes(const Scene& scene) {
    std::size_t corners = 0, vertices = 0;
    for (const Mesh& mesh : scene.meshes) {
        corners += 3 * mesh.triangles.size();
        vertices += mesh.positions.size();
    }
    if (std::max(corners, vertices) > std::numeric_limits<std::int32_t>::max()) {
        throw Error(fmt::format("{}: {} triangles are more than can be addressed", scene.source, corners / 3));
    }
    Geometry geometry;
    geometry.indices.reserve(corners);
    geometry.vertices.reserve(vertices);
    geometry.appearance.reserve(vertices);
    for (const Mesh& mesh : scene.meshes) append(geometry, mesh);
    return geometry;
}

std::vector<glm::vec3> box_corners(const Scene& scene, bool (Material::*which)() const) {
    std::vector<glm::vec3> corners;
    for (const Object& object : scene.objects) {
        if (!(scene.materials[std::size_t(object.material)].*which)()) continue;
        append_box_corners(scene.meshes[std::size_t(object.mesh)], object.world_from_object, corners);
    }
    return corners;
}

}  // namespace

void append_box_corners(const Mesh& mesh, const glm::mat4& world_from_object, std::vector<glm::vec3>& corners) {
    const auto [low, high] = box_of(mesh);
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z);
        corners.push_back(glm::vec3(world_from_object * glm::vec4(corner, 1.0f)));
    }
}

GpuScene::GpuScene(const Device& device, const Scene& scene) {
    const Geometry geometry = join_meshes(scene);
    TextureTable texture_table(scene);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        material_records.push_back(textured_record(material, texture_table));
        finish_records.push_back(textured_finish(material.finish, texture_table));
        update_records(material, m, material_records.back(), finish_records.back());
    }
    if (finish_records.empty()) finish_records.emplace_back();  // something has to be bound

    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const auto [low, high] = box_of(scene.meshes[m]);
        meshes.push_back({geometry.first_corner[m], std::uint32_t(scene.meshes[m].triangles.size()), low, high});
    }
    const std::vector<gpu::ObjectRecord> object_records = list_objects(scene);
    object_count = std::uint32_t(object_records.size());
    vertex_count = std::uint32_t(geometry.vertices.size());

    using Usage = vk::BufferUsageFlagBits;
    vk::BufferUsageFlags geometry_usage = Usage::eStorageBuffer;
    if (device.ray_tracing()) {
        geometry_usage |= Usage::eAccelerationStructureBuildInputReadOnlyKHR | Usage::eShaderDeviceAddress;
    }
    indices = upload_buffer(device, "the scene's triangles", geometry.indices, geometry_usage);
    vertices = upload_buffer(device, "the scene's vertices", geometry.vertices, geometry_usage);
    appearance = upload_buffer(device, "the scene's texture coordinates", geometry.appearance, Usage::eStorageBuffer);
    objects = upload_buffer(device, "the scene's objects", object_records, Usage::eStorageBuffer);
    materials = upload_buffer(device, "the scene's materials", material_records, Usage::eStorageBuffer);
    finishes = upload_buffer(device, "the scene's finishes", finish_records, Usage::eStorageBuffer);
    tangents = upload_buffer(device, "the scene's tangents", packed_tangents(scene), Usage::eStorageBuffer);
    texture_pages = texture_table.upload_pages(device);
    textures = upload_buffer(device, "the scene's textures", texture_table.records(), Usage::eStorageBuffer);
    set_lights(device, scene.lights);
    list_emitters(device, scene);
}

std::vector<gpu::ObjectRecord> GpuScene::list_objects(const Scene& scene) {
    bounds = scene_bounds(scene);
    refractive_corners = box_corners(scene, &Material::refractive);
    translucent_corners = box_corners(scene, &Material::translucent);
    for (auto* list : {&refractive, &thin_walled, &opaque, &translucent}) list->clear();
    first_triangles.clear();
    mesh_of_object.clear();
    world_from_object.clear();
    rough_glass = textured_glass = dispersive = rough = finished = false;
    triangle_count = 0;
    std::vector<gpu::ObjectRecord> object_records;
    for (const Object& object : scene.objects) {
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        const Material& material = scene.materials[std::size_t(object.material)];
        gpu::ObjectRecord record{};
        record.world_from_object = object.world_from_object;
        record.world_from_object_normal = glm::mat4(glm::transpose(glm::inverse(glm::mat3(object.world_from_object))));
        record.material = std::uint32_t(object.material);
        record.first_triangle = std::uint32_t(triangle_count);
        first_triangles.push_back(record.first_triangle);
        world_from_object.push_back(object.world_from_object);
        mesh_of_object.push_back(std::uint32_t(object.mesh));
        record.first_corner = meshes[std::size_t(object.mesh)].first_corner;
        record.mirrored = glm::determinant(glm::mat3(object.world_from_object)) < 0.0f ? 1u : 0u;

        const DrawCall call{record.first_corner, std::uint32_t(3 * mesh.triangles.size()),
                            std::uint32_t(object_records.size())};
        auto& list = material.refractive() ? refractive : material.transmissive() ? thin_walled : opaque;
        list.push_back(call);
        if (material.translucent()) translucent.push_back(call);
        finished = finished || (!material.transmissive() && has_finish(material));
        rough = rough || (material.transmissive() ? material.roughness > 0.0f : !material.unlit);
        textured_glass =
            textured_glass || (material.transmissive() &&
                               (material.base_color_texture.image >= 0 || material.transmission_texture.image >= 0 ||
                                material.metallic_roughness_texture.image >= 0 || material.normal_texture.image >= 0 ||
                                !mesh.colors.empty()));
        if (material.refractive()) {
            rough_glass = rough_glass || material.roughness > 0.0f;
            dispersive = dispersive || material.dispersion > 0.0f;
        }
        object_records.push_back(record);
        triangle_count += mesh.triangles.size();
    }
    if (triangle_count >= PELLUCID_BACK_FACE) {
        throw Error(fmt::format("{}: {} triangles are more than can be addressed", scene.source, triangle_count));
    }
    return object_records;
}

void GpuScene::list_emitters(const Device& device, const Scene& scene) {
    std::vector<EmitterRecord> records = emitters_of(scene, first_triangles);
    emitter_count = std::uint32_t(records.size());
    emitted_power = 0.0f;
    if (!records.empty()) {
        const Object& first = scene.objects[records.front().object];
        const glm::vec3 emission = scene.materials[std::size_t(first.material)].emission;
        emitted_power = (emission.r + emission.g + emission.b) / records.front().density;
    }
    if (records.empty()) records.push_back({});  // something has to be bound
    write_buffer(device, emitters, "emissive triangles", records);
}

void GpuScene::set_lights(const Device& device, std::span<const Light> given) {
    std::vector<PunctualLight> records(std::max<std::size_t>(given.size(), 1));  // something has to be bound
    std::transform(given.begin(), given.end(), records.begin(), punctual_light);
    light_count = std::uint32_t(given.size());
    write_buffer(device, lights, "the scene's lights", records);
}

void GpuScene::prepare_topology(const Device& device, const Scene& scene) {
    if (!topology) topology.emplace(device, scene);
    if (topology->moves != moves) topology->update(device, scene, moves);
}

void GpuScene::move_vertices(const Device& device, const Scene& scene, std::span<const int> moved) {
    if (moved.empty()) return;
    // First, so that nothing derived from the old shape passes for current if an upload fails.
    ++moves;
    bounds = scene_bounds(scene);
    refractive_corners = box_corners(scene, &Material::refractive);
    translucent_corners = box_corners(scene, &Material::translucent);
    const bool glass = std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return scene.materials[std::size_t(object.material)].refractive() &&
               std::find(moved.begin(), moved.end(), object.mesh) != moved.end();
    });
    if (glass) prepared.clear();
    for (const int mesh : moved) {
        GpuMesh& own = meshes[std::size_t(mesh)];
        std::tie(own.low, own.high) = box_of(scene.meshes[std::size_t(mesh)]);
        own.moves = moves;
        std::size_t first = 0;  // vertices of the meshes before
        for (int m = 0; m < mesh; ++m) first += scene.meshes[std::size_t(m)].positions.size();
        const std::vector<Vertex> data = vertices_of(scene.meshes[std::size_t(mesh)]);
        upload_later(device, vertices, std::as_bytes(std::span(data)), first * sizeof(Vertex));
        if (tangents.size() == vertex_count * sizeof(std::uint32_t)) {
            const std::vector<std::uint32_t> none(data.size(), 0);  // the triangles' texture coordinates say them
            upload_later(device, tangents, std::as_bytes(std::span(none)), first * sizeof(std::uint32_t));
        }
    }
    if (emitter_count > 0) list_emitters(device, scene);
}

void GpuScene::move_objects(const Device& device, const Scene& scene, std::span<const int> moved) {
    if (moved.empty()) return;
    ++moves;
    object_moves.resize(object_count, 0);
    bool glass = false;
    for (const int object : moved) {
        object_moves[std::size_t(object)] = moves;
        const Object& own = scene.objects[std::size_t(object)];
        glass = glass || scene.materials[std::size_t(own.material)].refractive();
    }
    if (glass) prepared.clear();
    topology.reset();  // who displaces whom may differ
    const std::vector<gpu::ObjectRecord> records = list_objects(scene);
    upload_later(device, objects, std::as_bytes(std::span(records)));
    if (emitter_count > 0) list_emitters(device, scene);
}

void GpuScene::set_material(const Device& device, const Scene& scene, std::size_t material, bool was_refractive) {
    ++moves;
    object_moves.assign(object_count, moves);
    if (was_refractive != scene.materials[material].refractive()) prepared.clear();
    topology.reset();
    gpu::MaterialRecord& record = material_records[material];
    gpu::FinishRecord& finish = finish_records[material];
    update_records(scene.materials[material], material, record, finish);
    upload_later(device, finishes, std::as_bytes(std::span(&finish, 1)), material * sizeof(finish));
    upload_later(device, materials, std::as_bytes(std::span(&record, 1)), material * sizeof(record));
    const std::vector<gpu::ObjectRecord> records = list_objects(scene);
    upload_later(device, objects, std::as_bytes(std::span(records)));
    list_emitters(device, scene);
}

}  // namespace pellucid
