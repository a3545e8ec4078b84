#pragma once

#include "viewer/document.h"

#include <pellucid/pellucid.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace pellucid::viewer {

/// Gives a renderer what a document shows: only what has changed since the last time.
class Stage {
public:
    explicit Stage(Renderer& renderer) : renderer_(renderer) {}

    /// `before_scene` is called before Renderer::set_scene(): no frame may be unread then. True: something has changed.
    bool apply(const Document& document, const std::function<void()>& before_scene);
    /// The scene as it is drawn.
    const Scene& scene() const { return scene_; }
    /// The camera as it is drawn.
    const Camera& camera() const { return camera_; }

private:
    bool apply_scene(const Document& document, const std::function<void()>& before_scene);
    bool apply_materials(const Look& look);
    bool apply_lights(const Look& look);
    bool apply_pose(const Document& document);
    bool apply_environment(const Document& document);

    Renderer& renderer_;
    Scene scene_;
    Camera camera_;
    std::uint64_t scene_number_ = 0, environment_number_ = 0;
    std::pair<float, float> turned_{0.0f, 1.0f};  ///< rotation and intensity of the environment
    std::optional<Look> applied_;                 ///< none: a scene is new
};

}  // namespace pellucid::viewer
