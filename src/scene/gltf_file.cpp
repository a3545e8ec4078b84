// The containers of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, sections 3.6 and 4.4).
#include "scene/gltf_file.h"

#include "core/fail.h"
#include "core/file.h"
#include "scene/gltf_draco.h"
#include "scene/gltf_json.h"
#include "scene/gltf_meshopt.h"
#include "scene/gltf_uri.h"

#include <pellucid/error.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <string_view>

namespace pellucid {
namespace {

using nlohmann::json;

constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t value = 0;  // little-endian, as are all machines that Vulkan runs on
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

/// Whether the rest of the file, from `at` on, is one chunk of binary data.
bool begins_chunk(std::span<const std::byte> file, std::size_t at) {
    return at + 8 <= file.size() && u32_at(file, at + 4) == kBin && u32_at(file, at) <= file.size() - at - 8;
}

/// Splits the file into its JSON text and the binary chunk, which only .glb files have.
void split_container(const std::filesystem::path& path, std::span<const std::byte> file, std::string_view& text,
                     std::span<const std::byte>& binary) {
    if (file.empty()) fail(path, "is empty");
    text = text_of(file);
    if (!text.starts_with("glTF")) return;
    text = {};
    if (file.size() < 20) fail(path, "GLB header is incomplete");
    if (u32_at(file, 4) != 2) fail(path, fmt::format("GLB version {} is not supported", u32_at(file, 4)));
    const std::size_t length = u32_at(file, 8);
    if (length > file.size() || length < 20)
        fail(path, fmt::format("GLB header announces {} bytes, the file has {} (truncated?)", length, file.size()));
    for (std::size_t at = 12; at + 8 <= length;) {
        const std::size_t size = u32_at(file, at);
        const std::uint32_t type = u32_at(file, at + 4);
        if (size > length - at - 8) fail(path, "GLB chunk is longer than the file");
        const auto chunk = file.subspan(at + 8, size);
        if (at == 12 && type != kJson) fail(path, "GLB file does not begin with its JSON chunk");
        if (at == 12) text = text_of(chunk);
        if (at != 12 && type == kBin && binary.empty()) binary = chunk;
        // Chunks end at multiples of 4 bytes, but some programs do not fill them up.
        const std::size_t end = at + 8 + size, padded = at + 8 + (size + 3) / 4 * 4;
        at = end != padded && begins_chunk(file.first(length), end) ? end : padded;
    }
}

/// Buffers of EXT_meshopt_compression that only say how large the decoded data is.
bool is_fallback(const json& buffer) {
    const auto extensions = buffer.find("extensions");
    if (extensions == buffer.end() || !extensions->is_object()) return false;
    for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        if (const auto found = extensions->find(name); found != extensions->end() && found->is_object())
            return found->value("fallback", json()) == true;
    return false;
}

void read_buffers(GltfFile& gltf, const json& root, std::span<const std::byte> binary) {
    const json buffers = root.value("buffers", json::array());
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::size_t length = buffers[i].at("byteLength").get<std::size_t>();
        const std::string uri = buffers[i].value("uri", std::string());
        std::vector<std::byte> bytes;
        if (!uri.empty()) {
            try {
                bytes = read_gltf_uri(gltf.scope, uri);
            } catch (const Error& error) {
                fail(gltf.path, fmt::format("buffer {}: {}", i, error.what()));
            }
        } else if (is_fallback(buffers[i])) {
            gltf.buffers.emplace_back();
            continue;
        } else if (i == 0) {
            bytes.assign(binary.begin(), binary.end());
        }
        if (bytes.size() < length)
            fail(gltf.path,
                 fmt::format("buffer {}{} has {} bytes, {} are needed", i,
                             uri.empty() || uri.starts_with("data:") ? "" : " (" + uri + ")", bytes.size(), length));
        gltf.memory.take(length);
        bytes.resize(length);
        gltf.buffers.push_back(std::move(bytes));
    }
}

/// Images are of use only to the eye: whatever is wrong with one is a warning.
void read_images(GltfFile& gltf, const json& root) {
    const json images = root.value("images", json::array());
    for (std::size_t i = 0; i < images.size(); ++i) {
        GltfImage image;
        image.name = fmt::format("image {}", i);
        try {
            const std::string uri = images[i].value("uri", std::string());
            const std::string name = images[i].value("name", std::string());
            if (!uri.empty() && !uri.starts_with("data:")) {
                image.name = percent_decoded(uri);
            } else if (!name.empty()) {
                image.name = name;
            }
            if (uri.starts_with("data:")) {
                image.bytes = read_gltf_uri(gltf.scope, uri);
            } else if (!uri.empty()) {
                image.file = gltf_uri_file(gltf.scope, uri);
            } else {
                image.view = gltf.view(images[i].at("bufferView").get<int>(), image.name);
            }
        } catch (const Error& error) {
            image.problem = error.what();
        } catch (const json::exception&) {
            image.problem = image.name + " names neither a file nor a buffer view";
        }
        gltf.images.push_back(std::move(image));
    }
}

}  // namespace

bool GltfImage::is_ktx2() const {
    constexpr std::string_view kMagic = "\xabKTX 20\xbb";
    if (!file.empty()) return text_of(first_bytes(file, kMagic.size())) == kMagic;
    return text_of(view.empty() ? std::span<const std::byte>(bytes) : view).starts_with(kMagic);
}

std::span<const std::byte> GltfFile::view(int buffer_view, const std::string& user) const {
    if (buffer_view < 0 || std::size_t(buffer_view) >= model.bufferViews.size())
        fail(path, fmt::format("{}: there is no buffer view {}", user, buffer_view));
    const tinygltf::BufferView& v = model.bufferViews[std::size_t(buffer_view)];
    if (v.buffer < 0 || std::size_t(v.buffer) >= buffers.size())
        fail(path, fmt::format("{}: buffer view {}: there is no buffer {}", user, buffer_view, v.buffer));
    const std::vector<std::byte>& buffer = buffers[std::size_t(v.buffer)];
    if (v.byteOffset > buffer.size() || v.byteLength > buffer.size() - v.byteOffset)
        fail(path, fmt::format("{}: buffer view {} reaches beyond its buffer", user, buffer_view));
    return std::span(buffer).subspan(v.byteOffset, v.byteLength);
}

void read_gltf_file(GltfFile& gltf, Warnings& warnings) {
    const std::filesystem::path& path = gltf.path;
    gltf.memory.take(check_readable(path));
    const std::vector<std::byte> file = read_file(path);
    std::string_view text;
    std::span<const std::byte> binary;
    split_container(path, file, text, binary);
    try {
        const json root = parse_gltf_json(path, text, warnings);
        gltf.model = gltf_model(path, root, warnings);
        read_buffers(gltf, root, binary);
        decode_meshopt(gltf);
        decode_draco(gltf, warnings);
        read_images(gltf, root);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& cause) {
        // Values of an unexpected JSON type, here or in tinygltf.
        fail(path, std::string("malformed glTF: ") + cause.what());
    }
}

}  // namespace pellucid
