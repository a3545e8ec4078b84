#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::cli {

/// A model that measurements call for and that is no part of the project.
struct Model {
    const char* name;
    std::array<const char*, 2> files;  ///< in the folder of models, the first that is there; nullptr: no second
    const char* installed = nullptr;   ///< where Debian puts one like it
};

inline constexpr Model kBunny{"bunny", {"bunny_closed_69664.obj", "bunny.obj"}, "/usr/share/glmark2/models/bunny.obj"};
inline constexpr Model kCow{"cow", {"cow.obj", "cow_5804.obj"}};

/// The folder of models, empty for none, and what was not found in it.
class ModelFolder {
public:
    ModelFolder(std::filesystem::path folder, std::vector<std::string>& warnings)
        : folder_(std::move(folder)), warnings_(warnings) {}

    /// The model's file; empty, with a warning that names it, if it is nowhere.
    std::filesystem::path find(const Model& model);

private:
    std::filesystem::path folder_;
    std::vector<std::string>& warnings_;
};

}  // namespace pellucid::cli
