#pragma once

// glTF files whose meshes are compressed by Draco or meshopt.
#include "gltf_builder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace pellucid::test {

/// The buffer view's bytes, encoded by meshopt, take its place.
inline void set_meshopt(GltfBuilder& b, int view, const std::vector<unsigned char>& encoded, std::size_t stride,
                        std::size_t count, const char* mode, const char* filter = nullptr) {
    json& v = b.root["bufferViews"][std::size_t(view)];
    b.bin.resize((b.bin.size() + 3) / 4 * 4);
    json extension = {{"buffer", 0},
                      {"byteOffset", b.bin.size()},
                      {"byteLength", encoded.size()},
                      {"byteStride", stride},
                      {"count", count},
                      {"mode", mode}};
    if (filter) extension["filter"] = filter;
    b.bin.append(reinterpret_cast<const char*>(encoded.data()), encoded.size());
    v["extensions"] = {{"EXT_meshopt_compression", extension}};
    v["buffer"] = 1;
    v["byteOffset"] = 0;
    v["byteLength"] = stride * count;
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
}

inline std::vector<unsigned char> encoded_vertices(const void* data, std::size_t count, std::size_t stride) {
    std::vector<unsigned char> encoded(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), data, count, stride));
    return encoded;
}

/// A square of two triangles with a texture coordinate, encoded by Draco.
struct DracoSquare {
    std::string bytes;
    int position = 0, texcoord = 0;
};

inline DracoSquare draco_square(bool keep_order) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    DracoSquare square;
    square.position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    square.texcoord = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
    const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const int triangles[2][3] = {{0, 1, 2}, {2, 1, 3}};
    for (int t = 0; t < 2; ++t) {
        const int* const v = triangles[t];
        const draco::FaceIndex face(static_cast<std::uint32_t>(t));
        builder.SetAttributeValuesForFace(square.position, face, corners[v[0]], corners[v[1]], corners[v[2]]);
        builder.SetAttributeValuesForFace(square.texcoord, face, corners[v[0]], corners[v[1]], corners[v[2]]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(keep_order ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    square.bytes.assign(buffer.data(), buffer.size());
    square.position = int(mesh->attribute(square.position)->unique_id());
    square.texcoord = int(mesh->attribute(square.texcoord)->unique_id());
    return square;
}

/// A file of the square; its accessors have no data of their own.
inline GltfBuilder draco_file(const DracoSquare& square) {
    GltfBuilder b;
    const int position = b.accessor(-1, kFloat, "VEC3", 4);
    const int texcoord = b.accessor(-1, kFloat, "VEC2", 4);
    const int indices = b.accessor(-1, kUnsignedShort, "SCALAR", 6);
    const int view = b.view(std::vector<char>(square.bytes.begin(), square.bytes.end()));
    json& primitive = b.mesh({{"POSITION", position}, {"TEXCOORD_0", texcoord}}, {{"indices", indices}});
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", square.position}, {"TEXCOORD_0", square.texcoord}}}};
    b.node({{"mesh", 0}, {"name", "thing"}});
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return b;
}

}  // namespace pellucid::test
