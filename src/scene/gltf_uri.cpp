// URIs of glTF 2.0 (Khronos Group, glTF 2.0 Specification, 2021, section 2.8), and data URIs (RFC 2397).
#include "scene/gltf_uri.h"

#include "core/fail.h"
#include "core/file.h"

#include <pellucid/error.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <system_error>

namespace pellucid {
namespace {

/// Both alphabets of RFC 4648, -1 for other characters.
constexpr std::array<std::int8_t, 256> base64_values() {
    std::array<std::int8_t, 256> values{};
    values.fill(-1);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) values[std::uint8_t(kAlphabet[i])] = std::int8_t(i);
    values[std::uint8_t('-')] = 62;
    values[std::uint8_t('_')] = 63;
    return values;
}

std::vector<std::byte> decode_base64(std::string_view text) {
    constexpr std::array<std::int8_t, 256> kValues = base64_values();
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        const int value = kValues[std::uint8_t(c)];
        if (value < 0) throw Error("damaged data URI: a character is not base64");
        bits = bits << 6 | std::uint32_t(value);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(std::byte(bits >> count & 0xffu));
    }
    return bytes;
}

std::vector<std::byte> bytes_of(const std::string& text) {
    std::vector<std::byte> bytes(text.size());
    if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

std::vector<std::byte> decode_data_uri(const std::string& uri) {
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos) throw Error("damaged data URI: it has no comma");
    const std::string_view head = std::string_view(uri).substr(0, comma);
    if (head.ends_with(";base64")) {
        const std::string content = uri.substr(comma + 1);
        return decode_base64(content.find('%') == content.npos ? content : percent_decoded(content));
    }
    return bytes_of(percent_decoded(uri.substr(comma + 1)));
}

}  // namespace

std::string percent_decoded(const std::string& uri) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
            decoded += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            decoded += uri[i];
        }
    }
    return decoded;
}

std::filesystem::path gltf_uri_file(const FileScope& scope, const std::string& uri) {
    if (uri.starts_with("http://") || uri.starts_with("https://"))
        throw Error(uri + ": is on a network: save it beside the glTF file and name it there");
    // Some programs write names as they are, or with the separators of Windows.
    std::string slashes = percent_decoded(uri);
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    for (const std::string& name : {percent_decoded(uri), uri, slashes}) {
        const std::filesystem::path file = scope.folder / name;
        scope.check(file);
        std::error_code error;
        if (!std::filesystem::exists(file, error)) continue;
        check_readable(file);
        return file;
    }
    fail(scope.folder / percent_decoded(uri), "no such file");
}

std::vector<std::byte> read_gltf_uri(const FileScope& scope, const std::string& uri) {
    return uri.starts_with("data:") ? decode_data_uri(uri) : read_file(gltf_uri_file(scope, uri));
}

}  // namespace pellucid
