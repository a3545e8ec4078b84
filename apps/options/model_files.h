#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::cli {

/// A model for measurements that is not part of the project.
struct Model {
    const char* name;
    /// file names in the folder of models; the first existing one is used; nullptr: no second name
    std::array<const char*, 2> files;
    const char* installed = nullptr;  ///< path of a similar model in Debian
};

inline constexpr Model kBunny{"bunny", {"bunny_closed_69664.obj", "bunny.obj"}, "/usr/share/glmark2/models/bunny.obj"};
inline constexpr Model kCow{"cow", {"cow.obj", "cow_5804.obj"}};

/// The folder of models, empty for none, and warnings about missing models.
class ModelFolder {
public:
    ModelFolder(std::filesystem::path folder, std::vector<std::string>& warnings)
        : folder_(std::move(folder)), warnings_(warnings) {}

    /// The model's file; empty if it is missing, with a warning that names it.
    std::filesystem::path find(const Model& model);

private:
    std::filesystem::path folder_;
    std::vector<std::string>& warnings_;
};

}  // namespace pellucid::cli
