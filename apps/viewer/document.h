#pragma once

#include "options/options.h"
#include "viewer/look.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid::viewer {

/// A loaded scene, a loaded environment, and the look that the user gives them, with its history.
class Document {
public:
    /// Loads a scene and replaces the old one, whose technique, environment and display values the look keeps. Throws Error, and
    /// changes nothing, if that fails.
    void open(const std::string& source, const cli::SceneArguments& how, std::uint32_t width, std::uint32_t height);
    /// Loads what environment() is from now on, and puts its name into the look. Throws Error likewise.
    void open_environment(const std::string& name_or_file);

    const Scene& scene() const { return scene_; }            ///< as loaded
    const Bounds& bounds() const { return bounds_; }         ///< of scene()
    const cli::SceneArguments& how() const { return how_; }  ///< the options that scene() was loaded with
    const Environment& environment() const { return environment_; }
    const std::vector<AnimationInfo>& animations() const { return animations_; }
    std::uint64_t scene_number() const { return scene_number_; }  ///< ascends with each scene
    std::uint64_t environment_number() const { return environment_number_; }

    Look look;

    /// Makes the look a step of the history, if it differs from the last one.
    void commit();
    /// False: there is nothing to undo. An environment that the older look names is loaded again, which may throw.
    bool undo();
    bool redo();
    /// `look` fits to the scene: it has as many materials, lights and animations.
    bool fits(const Look& other) const;

private:
    bool go(std::size_t step);

    Scene scene_;
    Bounds bounds_;
    cli::SceneArguments how_;
    Environment environment_;
    std::string environment_name_ = "studio";
    std::vector<AnimationInfo> animations_;
    std::uint64_t scene_number_ = 0, environment_number_ = 1;
    std::vector<Look> history_;
    std::size_t step_ = 0;  ///< of history_, that the look comes from
};

}  // namespace pellucid::viewer
