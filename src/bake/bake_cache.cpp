#include "bake/bake_cache.h"

#include "core/file.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

namespace pellucid::bake {
namespace {

constexpr std::uint32_t kVersion = 1;                    // of the file format and of the computations
constexpr std::size_t kMemory = std::size_t(256) << 20;  // most bytes kept, not counting the latest values

/// FNV-1a, 64 bits (Fowler, Noll & Vo 1991).
class Hash {
public:
    template <class T>
    void add(std::span<const T> values) {
        for (const std::byte byte : std::as_bytes(values)) {
            state_ = (state_ ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
        }
    }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0xcbf29ce484222325u;
};

struct Header {
    std::array<char, 8> magic;
    std::uint32_t version;
    std::uint32_t reserved;
    std::uint64_t key;
    std::uint64_t count;
    std::uint64_t checksum;  ///< of the values
};
static_assert(sizeof(Header) == 40);
constexpr std::array<char, 8> kMagic = {'P', 'E', 'L', 'B', 'A', 'K', 'E', '\n'};

std::uint64_t checksum(const std::vector<float>& values) {
    Hash hash;
    hash.add(std::span(values));
    return hash.value();
}

std::uint64_t key_of(const Mesh& mesh, const Quantity& quantity) {
    Hash hash;
    const std::array<std::uint64_t, 5> counts = {mesh.positions.size(), mesh.normals.size(), mesh.triangles.size(),
                                                 quantity.count, quantity.parameters.size()};
    hash.add(std::span<const std::uint64_t>(counts));
    hash.add(std::span(quantity.name));
    hash.add(quantity.parameters);
    hash.add(std::span(mesh.positions));
    hash.add(std::span(mesh.normals));
    hash.add(std::span(mesh.triangles));
    return hash.value();
}

std::string key_name(const Quantity& quantity, std::uint64_t hash) {
    return fmt::format("{}-{:016x}.bake", quantity.name, hash);
}

/// The values of a file; nullopt if it is missing, damaged or of another key.
std::optional<std::vector<float>> load(const std::filesystem::path& file, std::uint64_t key, std::size_t count) {
    std::error_code error;
    // Check the size before reading, because any file may be there.
    if (std::filesystem::file_size(file, error) != sizeof(Header) + count * sizeof(float) || error) return {};
    try {
        const std::vector<std::byte> bytes = read_file(file);
        if (bytes.size() != sizeof(Header) + count * sizeof(float)) return {};
        Header header;
        std::memcpy(&header, bytes.data(), sizeof(header));
        std::vector<float> values(count);
        std::copy_n(bytes.data() + sizeof(header), count * sizeof(float),
                    std::as_writable_bytes(std::span(values)).data());
        const bool right = header.magic == kMagic && header.version == kVersion && header.key == key &&
                           header.count == count && header.checksum == checksum(values);
        if (!right) return {};
        return values;
    } catch (const Error&) {
        return {};
    }
}

const char* variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' ? value : nullptr;
}

}  // namespace

std::filesystem::path default_cache_folder() {
    if (const char* own = variable("PELLUCID_CACHE_DIR")) return own;
    if (const char* caches = variable("XDG_CACHE_HOME"); caches && std::filesystem::path(caches).is_absolute()) {
        return std::filesystem::path(caches) / "pellucid";
    }
    if (const char* home = variable("HOME")) return std::filesystem::path(home) / ".cache" / "pellucid";
    return {};
}

std::filesystem::path BakeCache::file_of(const Mesh& mesh, const Quantity& quantity) const {
    return folder_ / key_name(quantity, key_of(mesh, quantity));
}

BakeCache::Values BakeCache::get(const Mesh& mesh, const Quantity& quantity, const Compute& compute,
                                 std::vector<std::string>& warnings) {
    const std::uint64_t hash = key_of(mesh, quantity);
    const std::string key = key_name(quantity, hash);
    const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
    if (known != entries_.end()) return known->values;
    std::optional<std::vector<float>> loaded;
    if (!folder_.empty()) loaded = load(folder_ / key, hash, quantity.count);
    const bool is_new = !loaded;
    auto values = std::make_shared<const std::vector<float>>(is_new ? compute() : std::move(*loaded));
    if (is_new) store(key, hash, *values, warnings);
    remember(key, values);
    return values;
}

void BakeCache::remember(const std::string& key, Values values) {
    entries_.push_back({key, std::move(values)});
    const auto bytes = [&] {
        std::size_t sum = 0;
        for (const Entry& entry : entries_) sum += entry.values->size() * sizeof(float);
        return sum;
    };
    while (entries_.size() > 1 && bytes() > kMemory) entries_.pop_front();
}

void BakeCache::store(const std::string& key, std::uint64_t hash, const std::vector<float>& values,
                      std::vector<std::string>& warnings) {
    if (folder_.empty()) return;
    try {
        std::error_code error;
        std::filesystem::create_directories(folder_, error);  // a failure is reported below
        write_file_atomically(folder_ / key, [&](const std::filesystem::path& temporary) {
            const Header header{kMagic, kVersion, 0, hash, values.size(), checksum(values)};
            std::ofstream stream(temporary, std::ios::binary);
            stream.write(reinterpret_cast<const char*>(&header), sizeof(header));
            stream.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * sizeof(float)));
            stream.close();
            if (!stream) throw Error(fmt::format("{}: cannot be written", (folder_ / key).string()));
        });
    } catch (const Error& cause) {
        if (!std::exchange(warned_, true)) {
            warnings.push_back(fmt::format("what is baked is not kept for the next run: {}", cause.what()));
        }
    }
}

}  // namespace pellucid::bake
