// KHR_draco_mesh_compression (Khronos Group, glTF extensions/2.0/Khronos/KHR_draco_mesh_compression, 2018).
#include "scene/gltf_draco.h"

#include "core/fail.h"
#include "scene/gltf_properties.h"

#include <pellucid/error.h>

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace pellucid {
namespace {

constexpr const char* kDraco = "KHR_draco_mesh_compression";

std::unique_ptr<draco::Mesh> decode_mesh(std::span<const std::byte> data) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(data.data()), data.size());
    draco::Decoder decoder;
    draco::StatusOr<std::unique_ptr<draco::Mesh>> mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok()) throw Error(mesh.status().error_msg_string());
    return std::move(mesh).value();
}

template <typename T>
void append_values(const draco::PointAttribute& attribute, std::uint32_t points, int components,
                   std::vector<std::byte>& out) {
    std::vector<T> value(std::size_t(components), T(0));
    out.resize(std::size_t(points) * value.size() * sizeof(T));
    std::byte* at = out.data();
    for (std::uint32_t p = 0; p < points; ++p) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(p));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<T>(index, std::int8_t(components), value.data()))
            throw Error("an attribute has another type than its accessor");
        std::memcpy(at, value.data(), value.size() * sizeof(T));
        at += value.size() * sizeof(T);
    }
}

/// Values of an attribute for all points, tightly packed, in the component type of its accessor.
std::vector<std::byte> values_of(const draco::PointAttribute& attribute, std::uint32_t points, int component_type,
                                 int components) {
    std::vector<std::byte> values;
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            append_values<std::int8_t>(attribute, points, components, values);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            append_values<std::uint8_t>(attribute, points, components, values);
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            append_values<std::int16_t>(attribute, points, components, values);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            append_values<std::uint16_t>(attribute, points, components, values);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            append_values<std::uint32_t>(attribute, points, components, values);
            break;
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            append_values<float>(attribute, points, components, values);
            break;
        default:
            throw Error("an accessor has an unknown component type");
    }
    return values;
}

class PrimitiveDecoder {
public:
    explicit PrimitiveDecoder(GltfFile& gltf) : gltf_(gltf) {}

    /// Changes the primitive only if all of it could be decoded. Throws Error otherwise.
    void decode(tinygltf::Primitive& primitive, const tinygltf::Value& extension, const std::string& user) {
        if (!extension.Has("bufferView") || !extension.Has("attributes") || !extension.Get("attributes").IsObject())
            throw Error("the extension names no buffer view or no attributes");
        const int view = gltf_integer(extension.Get("bufferView"));
        const std::unique_ptr<draco::Mesh> mesh = decode_mesh(gltf_.view(view, user));
        std::map<std::string, int> attributes = primitive.attributes;
        const tinygltf::Value& ids = extension.Get("attributes");
        for (const std::string& name : ids.Keys()) {
            const tinygltf::Value& id = ids.Get(name);
            const draco::PointAttribute* const attribute =
                id.IsNumber() ? mesh->GetAttributeByUniqueId(std::uint32_t(gltf_integer(id))) : nullptr;
            if (!attribute) throw Error(fmt::format("there is no attribute {} in it", name));
            const auto given = primitive.attributes.find(name);
            if (given == primitive.attributes.end()) continue;
            attributes[name] = add_attribute(*attribute, mesh->num_points(), given->second);
        }
        const int indices = add_indices(*mesh, primitive.indices);
        primitive.attributes = std::move(attributes);
        primitive.indices = indices;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;  // the decoder takes strips apart
    }

private:
    const tinygltf::Accessor& accessor_at(int index) const {
        if (index < 0 || std::size_t(index) >= gltf_.model.accessors.size())
            throw Error(fmt::format("there is no accessor {}", index));
        return gltf_.model.accessors[std::size_t(index)];
    }

    int add_attribute(const draco::PointAttribute& attribute, std::uint32_t points, int accessor) {
        tinygltf::Accessor decoded = accessor_at(accessor);
        const int components = tinygltf::GetNumComponentsInType(std::uint32_t(decoded.type));
        if (components < 1 || components > 4) throw Error(fmt::format("accessor {} is of no vector type", accessor));
        decoded.count = points;
        gltf_.memory.take(points, std::uint64_t(components) * sizeof(float));
        return add(std::move(decoded), values_of(attribute, points, decoded.componentType, components));
    }

    int add_indices(const draco::Mesh& mesh, int accessor) {
        tinygltf::Accessor decoded;
        if (accessor >= 0) decoded = accessor_at(accessor);
        decoded.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        decoded.type = TINYGLTF_TYPE_SCALAR;
        decoded.normalized = false;
        decoded.count = std::size_t(mesh.num_faces()) * 3;
        gltf_.memory.take(decoded.count, sizeof(std::uint32_t));
        std::vector<std::byte> bytes(decoded.count * sizeof(std::uint32_t));
        std::byte* at = bytes.data();
        for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
            for (const auto& point : mesh.face(draco::FaceIndex(f))) {
                const std::uint32_t index = point.value();
                std::memcpy(at, &index, sizeof index);
                at += sizeof index;
            }
        }
        return add(std::move(decoded), std::move(bytes));
    }

    int add(tinygltf::Accessor accessor, std::vector<std::byte> bytes) {
        tinygltf::BufferView view;
        view.buffer = static_cast<int>(gltf_.buffers.size());
        view.byteLength = bytes.size();
        gltf_.buffers.push_back(std::move(bytes));
        accessor.bufferView = static_cast<int>(gltf_.model.bufferViews.size());
        accessor.byteOffset = 0;
        accessor.sparse = {};
        gltf_.model.bufferViews.push_back(std::move(view));
        gltf_.model.accessors.push_back(std::move(accessor));
        return static_cast<int>(gltf_.model.accessors.size()) - 1;
    }

    GltfFile& gltf_;
};

/// Whether all that the extension holds is there uncompressed as well.
bool has_fallback(const GltfFile& gltf, const tinygltf::Primitive& primitive) {
    const auto stored = [&](int accessor) {
        return accessor >= 0 && std::size_t(accessor) < gltf.model.accessors.size() &&
               gltf.model.accessors[std::size_t(accessor)].bufferView >= 0;
    };
    for (const auto& [name, accessor] : primitive.attributes)
        if (!stored(accessor)) return false;
    return primitive.indices < 0 || stored(primitive.indices);
}

}  // namespace

void decode_draco(GltfFile& gltf, Warnings& warnings) {
    PrimitiveDecoder decoder(gltf);
    for (std::size_t m = 0; m < gltf.model.meshes.size(); ++m) {
        tinygltf::Mesh& mesh = gltf.model.meshes[m];
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            tinygltf::Primitive& primitive = mesh.primitives[p];
            const auto extension = primitive.extensions.find(kDraco);
            if (extension == primitive.extensions.end() || !extension->second.IsObject()) continue;
            const std::string user =
                fmt::format("mesh {} primitive {}", mesh.name.empty() ? std::to_string(m) : mesh.name, p);
            std::string problem;
            try {
                decoder.decode(primitive, extension->second, user);
                continue;
            } catch (const std::exception& error) {
                problem = error.what();
            }
            const std::string prefix = gltf.path.string() + ": ";
            if (problem.starts_with(prefix)) problem.erase(0, prefix.size());
            if (has_fallback(gltf, primitive)) {
                warnings.add(
                    fmt::format("{}: Draco data left out ({}), its uncompressed data is drawn", user, problem));
            } else {
                fail(gltf.path, fmt::format("{}: Draco data cannot be decoded ({}); export the file again, or without "
                                            "compression",
                                            user, problem));
            }
        }
    }
}

}  // namespace pellucid
