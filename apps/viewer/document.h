#pragma once

#include "options/options.h"
#include "viewer/look.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// A scene as a file has it, the options it was loaded with, and what follows from both.
struct LoadedScene {
    Scene scene;
    cli::SceneArguments how;
    Bounds bounds{};
    std::vector<AnimationInfo> animations{};
};
/// Throws Error.
LoadedScene load_document_scene(const std::string& source, const cli::SceneArguments& how);

struct LoadedEnvironment {
    Environment environment;
    std::string warning;  ///< empty: none
};

/// Throws Error.
LoadedEnvironment load_document_environment(const std::string& name_or_file);

/// A loaded scene, a loaded environment, and the look that the user gives them, with its history.
class Document {
public:
    /// Replaces the scene. The look keeps technique, environment and display values. Width and height: of the window.
    void show(LoadedScene loaded, std::uint32_t width, std::uint32_t height);
    /// Replaces environment(). The look may name another one, which is yet to be loaded.
    void show(std::string name, Environment environment);

    const Scene& scene() const { return loaded_.scene; }            ///< as loaded
    const Bounds& bounds() const { return loaded_.bounds; }         ///< of scene()
    const cli::SceneArguments& how() const { return loaded_.how; }  ///< the options that scene() was loaded with
    const std::vector<AnimationInfo>& animations() const { return loaded_.animations; }
    const Environment& environment() const { return environment_; }
    const std::string& environment_name() const { return environment_name_; }
    std::uint64_t scene_number() const { return scene_number_; }  ///< ascends with each scene
    std::uint64_t environment_number() const { return environment_number_; }

    Look look;

    /// Makes the look a step of the history, if it differs from the last one.
    void commit();
    /// False: there is nothing to undo.
    bool undo();
    bool redo();
    /// `look` fits to the scene: it has as many materials, lights and animations, and the camera.
    bool fits(const Look& other) const;

private:
    LoadedScene loaded_;
    Environment environment_;
    std::string environment_name_ = "studio";
    std::uint64_t scene_number_ = 0, environment_number_ = 1;
    std::vector<Look> history_;
    std::size_t step_ = 0;  ///< of history_, that the look comes from
};

}  // namespace pellucid::viewer
