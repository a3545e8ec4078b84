// EXT_meshopt_compression (Khronos Group, glTF extensions/2.0/Vendor/EXT_meshopt_compression, 2021).
#include "scene/gltf_meshopt.h"

#include "core/fail.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid {
namespace {

struct CompressedView {
    std::span<const std::byte> data;
    std::size_t stride = 0;
    std::size_t count = 0;
    std::string mode, filter;
};

class ViewReader {
public:
    ViewReader(const GltfFile& gltf, std::size_t view, const tinygltf::Value& extension)
        : gltf_(gltf), extension_(extension), user_(fmt::format("buffer view {}: meshopt data", view)) {}

    std::vector<std::byte> decode() const {
        const CompressedView view = read();
        // The codec stores at least two bits for 16 equal bytes, and a byte for a triangle.
        constexpr std::size_t kBestRatio = 64;
        if (view.stride == 0 || view.stride > 256 || view.count > (view.data.size() * kBestRatio) / view.stride)
            damaged(fmt::format("{} elements of {} bytes in {} bytes", view.count, view.stride, view.data.size()));
        gltf_.memory.take(view.count, view.stride);
        std::vector<std::byte> decoded(view.count * view.stride);
        if (decoded.empty()) return decoded;
        decode_elements(view, decoded);
        filter(view, decoded);
        return decoded;
    }

private:
    [[noreturn]] void damaged(const std::string& why) const {
        fail(gltf_.path,
             fmt::format("{} cannot be decoded ({}); export the file again, or without compression", user_, why));
    }

    std::size_t number(const char* key, std::size_t otherwise) const {
        if (!extension_.Has(key)) return otherwise;
        const tinygltf::Value& value = extension_.Get(key);
        const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1.0;
        if (!(number >= 0.0 && number < 4294967296.0)) damaged(fmt::format("{} is no size", key));
        return static_cast<std::size_t>(number);
    }

    std::string text(const char* key) const {
        return extension_.Has(key) && extension_.Get(key).IsString() ? extension_.Get(key).Get<std::string>() : "";
    }

    CompressedView read() const {
        CompressedView view;
        const std::size_t none = gltf_.buffers.size();
        const std::size_t buffer = number("buffer", none), offset = number("byteOffset", 0);
        const std::size_t length = number("byteLength", 0);
        if (buffer >= none) damaged("there is no such buffer");
        const std::span<const std::byte> bytes(gltf_.buffers[buffer]);
        if (offset > bytes.size() || length > bytes.size() - offset) damaged("it reaches beyond its buffer");
        view.data = bytes.subspan(offset, length);
        view.stride = number("byteStride", 0);
        view.count = number("count", 0);
        view.mode = text("mode");
        view.filter = text("filter");
        return view;
    }

    void decode_elements(const CompressedView& view, std::vector<std::byte>& decoded) const {
        const auto* const data = reinterpret_cast<const unsigned char*>(view.data.data());
        const std::size_t size = view.data.size();
        const bool index_size = view.stride == 2 || view.stride == 4;
        int error = 0;
        if (view.mode == "ATTRIBUTES") {
            if (view.stride % 4 != 0) damaged("the stride of attributes is no multiple of 4");
            if (size > 0 && (data[0] & 0x0f) != 0) damaged("its codec version is not 0");
            error = meshopt_decodeVertexBuffer(decoded.data(), view.count, view.stride, data, size);
        } else if (view.mode == "TRIANGLES") {
            if (!index_size || view.count % 3 != 0) damaged("these are no triangles of 2 or 4 byte indices");
            error = meshopt_decodeIndexBuffer(decoded.data(), view.count, view.stride, data, size);
        } else if (view.mode == "INDICES") {
            if (!index_size) damaged("these are no indices of 2 or 4 bytes");
            error = meshopt_decodeIndexSequence(decoded.data(), view.count, view.stride, data, size);
        } else {
            damaged(fmt::format("unknown mode '{}'", view.mode));
        }
        if (error != 0) damaged("damaged or truncated");
    }

    void filter(const CompressedView& view, std::vector<std::byte>& decoded) const {
        if (view.filter.empty() || view.filter == "NONE") return;
        if (view.filter == "OCTAHEDRAL") {
            if (view.stride != 4 && view.stride != 8) damaged("octahedral vectors have 4 or 8 bytes");
            meshopt_decodeFilterOct(decoded.data(), view.count, view.stride);
        } else if (view.filter == "QUATERNION") {
            if (view.stride != 8) damaged("quaternions have 8 bytes");
            meshopt_decodeFilterQuat(decoded.data(), view.count, view.stride);
        } else if (view.filter == "EXPONENTIAL") {
            if (view.stride % 4 != 0) damaged("exponential numbers have 4 bytes");
            meshopt_decodeFilterExp(decoded.data(), view.count, view.stride);
        } else {
            damaged(fmt::format("unknown filter '{}'", view.filter));
        }
    }

    const GltfFile& gltf_;
    const tinygltf::Value& extension_;
    std::string user_;
};

}  // namespace

void decode_meshopt(GltfFile& gltf) {
    for (std::size_t v = 0; v < gltf.model.bufferViews.size(); ++v) {
        tinygltf::BufferView& view = gltf.model.bufferViews[v];
        for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
            const auto extension = view.extensions.find(name);
            if (extension == view.extensions.end() || !extension->second.IsObject()) continue;
            gltf.buffers.push_back(ViewReader(gltf, v, extension->second).decode());
            view.buffer = static_cast<int>(gltf.buffers.size()) - 1;
            view.byteOffset = 0;
            view.byteLength = gltf.buffers.back().size();
            break;
        }
    }
}

}  // namespace pellucid
