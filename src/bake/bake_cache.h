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

/// What is baked of a mesh, and how many values that gives.
struct Quantity {
    std::string_view name;  ///< part of a file name
    std::size_t count;
    std::span<const std::uint32_t> parameters = {};
};

/// $PELLUCID_CACHE_DIR, else $XDG_CACHE_HOME/pellucid, else $HOME/.cache/pellucid; empty: there is none.
std::filesystem::path default_cache_folder();

/// Baked values, in memory and in a folder, by a hash of the mesh's positions, normals and triangles and of what is
/// baked. Files of the folder that are damaged or of another version are ignored and written anew; any may be
/// removed at any time. Without a folder that can be written there is memory alone.
class BakeCache {
public:
    explicit BakeCache(std::filesystem::path folder = default_cache_folder()) : folder_(std::move(folder)) {}

    using Values = std::shared_ptr<const std::vector<float>>;
    using Compute = std::function<std::vector<float>()>;
    /// The values, computed if they are nowhere. That the folder cannot be written is said once, in `warnings`.
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
    std::deque<Entry> entries_;  ///< the latest last
    bool warned_ = false;
};

}  // namespace pellucid::bake
