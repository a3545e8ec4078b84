#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::bake {

/// A baked quantity of a mesh, and the number of its values.
struct Quantity {
    std::string_view name;  ///< part of a file name
    std::size_t count;
    std::span<const std::uint32_t> parameters = {};
};

/// $PELLUCID_CACHE_DIR, else $XDG_CACHE_HOME/pellucid, else $HOME/.cache/pellucid; empty if none is set.
std::filesystem::path default_cache_folder();

/// A cache of baked values, in memory and in a folder. The key is a hash of the quantity and of the mesh's positions,
/// normals and triangles. Damaged files and files of another version are ignored and rewritten. Any file may be removed
/// at any time. Without a writable folder, values are kept in memory only.
class BakeCache {
public:
    explicit BakeCache(std::filesystem::path folder = default_cache_folder()) : folder_(std::move(folder)) {}

    using Values = std::shared_ptr<const std::vector<float>>;
    using Compute = std::function<std::vector<float>()>;
    /// Returns the values, and computes them if the cache has none. Appends one warning if the folder is not writable.
    Values get(const Mesh& mesh, const Quantity& quantity, const Compute& compute, std::vector<std::string>& warnings);

    /// The file that holds the values.
    std::filesystem::path file_of(const Mesh& mesh, const Quantity& quantity) const;

private:
    struct Entry {
        std::string key;
        Values values;
    };
    void remember(const std::string& key, Values values);
    void store(const std::string& key, std::uint64_t hash, const std::vector<float>& values,
               std::vector<std::string>& warnings);

    std::filesystem::path folder_;
    std::deque<Entry> entries_;  ///< in the order of insertion
    bool warned_ = false;
};

}  // namespace pellucid::bake
