#include "gpu/gpu_scene.h"

#include "gpu/texture_pages.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <limits>

namespace pellucid {
namespace {

struct GeometryVertex {
    glm::vec3 position;
    glm::vec3 normal;
};
static_assert(sizeof(GeometryVertex) == kGeometryStride);

struct AppearanceVertex {
    glm::vec2 texcoord[2];
    std::uint32_t color;
};
static_assert(sizeof(AppearanceVertex) == 20);

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

/// Corner-expanded vertices of every mesh, one after the other.
struct VertexStreams {
    std::vector<GeometryVertex> geometry;
    std::vector<AppearanceVertex> appearance;
    std::vector<std::uint32_t> first_vertex;  // per mesh
};

VertexStreams expand_meshes(const Scene& scene) {
    std::size_t corners = 0;
    for (const Mesh& mesh : scene.meshes) corners += 3 * mesh.triangles.size();
    if (corners > std::numeric_limits<std::int32_t>::max()) {
        throw Error(fmt::format("{}: {} triangles are more than can be addressed", scene.source, corners / 3));
    }
    VertexStreams streams;
    streams.geometry.reserve(corners);
    streams.appearance.reserve(corners);
    for (const Mesh& mesh : scene.meshes) {
        streams.first_vertex.push_back(std::uint32_t(streams.geometry.size()));
        for (const glm::uvec3& triangle : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t v = triangle[corner];
                AppearanceVertex look{};
                for (int set = 0; set < 2; ++set) {
                    if (!mesh.texcoords[set].empty()) look.texcoord[set] = mesh.texcoords[set][v];
                }
                look.color = mesh.colors.empty() ? ~0u : pack_color(mesh.colors[v]);
                streams.geometry.push_back({mesh.positions[v], mesh.normals[v]});
                streams.appearance.push_back(look);
            }
        }
    }
    return streams;
}

gpu::MaterialRecord material_record(const Material& material, TextureTable& textures) {
    gpu::MaterialRecord record{};
    record.base_color = material.base_color;
    record.emission = glm::vec4(material.emission, 0.0f);
    record.sigma_a = glm::vec4(material.sigma_a(), 0.0f);
    record.ior = material.ior;
    record.transmission = material.transmission;
    record.alpha_cutoff = material.alpha_cutoff;
    record.flags = material.unlit ? PELLUCID_MATERIAL_UNLIT : 0u;
    record.base_color_texture = textures.add(material.base_color_texture, true);
    record.emission_texture = textures.add(material.emission_texture, true);
    record.transmission_texture = textures.add(material.transmission_texture, false);
    return record;
}

void append_box_corners(const Mesh& mesh, const glm::mat4& world_from_object, std::vector<glm::vec3>& corners) {
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner((i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z);
        corners.push_back(glm::vec3(world_from_object * glm::vec4(corner, 1.0f)));
    }
}

}  // namespace

std::vector<std::uint32_t> stream_strides(bool with_appearance) {
    std::vector<std::uint32_t> strides{sizeof(GeometryVertex)};
    if (with_appearance) strides.push_back(sizeof(AppearanceVertex));
    return strides;
}

std::vector<Program::VertexAttribute> vertex_attributes(bool with_appearance) {
    std::vector<Program::VertexAttribute> attributes{{vk::Format::eR32G32B32Sfloat, 0, 0},
                                                     {vk::Format::eR32G32B32Sfloat, 0, 12}};
    if (with_appearance) {
        attributes.push_back({vk::Format::eR32G32Sfloat, 1, 0});
        attributes.push_back({vk::Format::eR32G32Sfloat, 1, 8});
        attributes.push_back({vk::Format::eR8G8B8A8Unorm, 1, 16});
    }
    return attributes;
}

GpuScene::GpuScene(const Device& device, const Scene& scene) : bounds(scene_bounds(scene)) {
    const VertexStreams streams = expand_meshes(scene);
    TextureTable texture_table(scene);
    std::vector<gpu::MaterialRecord> material_records;
    for (const Material& material : scene.materials)
        material_records.push_back(material_record(material, texture_table));

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
        record.first_vertex = streams.first_vertex[std::size_t(object.mesh)];
        record.mirrored = glm::determinant(glm::mat3(object.world_from_object)) < 0.0f ? 1u : 0u;

        const DrawCall call{record.first_vertex, std::uint32_t(3 * mesh.triangles.size()),
                            std::uint32_t(object_records.size())};
        auto& list = material.refractive() ? refractive : material.transmissive() ? thin_walled : opaque;
        list.push_back(call);
        if (material.refractive()) {
            append_box_corners(mesh, object.world_from_object, refractive_corners);
            const bool textured = material.base_color_texture.image >= 0 || material.transmission_texture.image >= 0;
            if (textured || !mesh.colors.empty()) textured_refractive.push_back(call);
        }
        object_records.push_back(record);
        triangle_count += mesh.triangles.size();
    }
    if (triangle_count >= PELLUCID_BACK_FACE) {
        throw Error(fmt::format("{}: {} triangles are more than can be addressed", scene.source, triangle_count));
    }
    object_count = std::uint32_t(object_records.size());

    using Usage = vk::BufferUsageFlagBits;
    vk::BufferUsageFlags geometry_usage = Usage::eVertexBuffer;
    if (device.ray_tracing()) {
        geometry_usage |= Usage::eAccelerationStructureBuildInputReadOnlyKHR | Usage::eShaderDeviceAddress;
    }
    geometry = upload_buffer(device, "the scene's vertices", streams.geometry, geometry_usage);
    appearance = upload_buffer(device, "the scene's texture coordinates", streams.appearance, Usage::eVertexBuffer);
    objects = upload_buffer(device, "the scene's objects", object_records, Usage::eStorageBuffer);
    materials = upload_buffer(device, "the scene's materials", material_records, Usage::eStorageBuffer);
    texture_pages = texture_table.upload_pages(device);
    textures = upload_buffer(device, "the scene's textures", texture_table.records(), Usage::eStorageBuffer);
}

}  // namespace pellucid
