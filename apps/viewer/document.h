#pragma once

#include "options/options.h"
#include "viewer/look.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// A scene as in its file, its load options, and derived data.
struct LoadedScene {
    Scene scene;
    cli::SceneArguments how;
    Bounds bounds{};
    std::vector<AnimationInfo> animations{};
};
/// Loads a scene. Throws Error.
LoadedScene load_document_scene(const std::string& source, const cli::SceneArguments& how);

struct LoadedEnvironment {
    Environment environment;
    std::string warning;  ///< empty: no warning
};

/// Loads an environment. Throws Error.
LoadedEnvironment load_document_environment(const std::string& name_or_file);

/// A loaded scene, a loaded environment, and their look as set by the user, with its history.
class Document {
public:
    /// Replaces the scene. The look keeps technique, environment and display values. `width`, `height`: of the window,
    /// pixels.
    void show(LoadedScene loaded, std::uint32_t width, std::uint32_t height);
    /// Replaces environment(). The look may already name another one that is not loaded yet.
    void show(std::string name, Environment environment);

    const Scene& scene() const { return loaded_.scene; }            ///< as loaded
    const Bounds& bounds() const { return loaded_.bounds; }         ///< of scene()
    const cli::SceneArguments& how() const { return loaded_.how; }  ///< load options of scene()
    const std::vector<AnimationInfo>& animations() const { return loaded_.animations; }
    const Environment& environment() const { return environment_; }
    const std::string& environment_name() const { return environment_name_; }
    std::uint64_t scene_number() const { return scene_number_; }  ///< ascends with each scene
    std::uint64_t environment_number() const { return environment_number_; }

    Look look;

    /// Adds the look to the history if it differs from the last step.
    void commit();
    /// Returns false if there is nothing to undo.
    bool undo();
    bool redo();
    /// True if the look fits the scene: equal numbers of materials and lights, an existing animation and camera.
    bool fits(const Look& other) const;

private:
    LoadedScene loaded_;
    Environment environment_;
    std::string environment_name_ = "studio";
    std::uint64_t scene_number_ = 0, environment_number_ = 1;
    std::vector<Look> history_;
    std::size_t step_ = 0;  ///< index into history_ of the current look
};

}  // namespace pellucid::viewer
