#pragma once

// Makes small glTF files, right ones and wrong ones.
#include "test_files.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace pellucid::test {

using nlohmann::json;

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;

struct GltfBuilder {
    json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string bin;

    /// Appends values as a buffer view; returns its number.
    template <typename T>
    int view(const std::vector<T>& values, int stride = 0) {
        bin.resize((bin.size() + 3) / 4 * 4);
        json v = {{"buffer", 0}, {"byteOffset", bin.size()}, {"byteLength", values.size() * sizeof(T)}};
        if (stride) v["byteStride"] = stride;
        bin.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        root["bufferViews"].push_back(v);
        return int(root["bufferViews"].size()) - 1;
    }
    int accessor(int buffer_view, int component_type, const char* type, std::size_t count, json more = json::object()) {
        more["componentType"] = component_type;
        more["type"] = type;
        more["count"] = count;
        if (buffer_view >= 0) more["bufferView"] = buffer_view;
        root["accessors"].push_back(more);
        return int(root["accessors"].size()) - 1;
    }
    template <typename T>
    int attribute(const std::vector<T>& values, int component_type, const char* type, int components) {
        return accessor(view(values), component_type, type, values.size() / std::size_t(components));
    }
    /// A mesh of one primitive; returns the primitive.
    json& mesh(json attributes, json more = json::object()) {
        more["attributes"] = attributes;
        root["meshes"].push_back({{"name", "thing"}, {"primitives", {more}}});
        return root["meshes"].back()["primitives"][0];
    }
    void node(json node) { root["nodes"].push_back(node); }

    /// One triangle in the xy plane, seen from +z.
    static GltfBuilder triangle() {
        GltfBuilder b;
        const int position = b.attribute<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, kFloat, "VEC3", 3);
        b.mesh({{"POSITION", position}});
        b.node({{"mesh", 0}, {"name", "thing"}});
        return b;
    }

    std::string gltf(const TemporaryFolder& folder, const std::string& name = "a.gltf") {
        root["buffers"] = {{{"uri", "a.bin"}, {"byteLength", bin.size()}}};
        folder.file("a.bin", bin);
        return folder.file(name, root.dump());
    }
    std::string glb_bytes() {
        root["buffers"] = {{{"byteLength", bin.size()}}};
        std::string text = root.dump(), data = bin;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4, '\0');
        std::string bytes = "glTF";
        const auto u32 = [&](std::size_t value) {
            const auto v = static_cast<std::uint32_t>(value);
            bytes.append(reinterpret_cast<const char*>(&v), 4);
        };
        u32(2);
        u32(12 + 8 + text.size() + 8 + data.size());
        u32(text.size());
        bytes += "JSON" + text;
        u32(data.size());
        bytes.append("BIN\0", 4);
        return bytes + data;
    }
    std::string glb(const TemporaryFolder& folder) { return folder.file("a.glb", glb_bytes()); }
};

}  // namespace pellucid::test
