#pragma once

#include "viewer/document.h"

#include <pellucid/pellucid.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

namespace pellucid::viewer {

/// Transfers a document to a renderer, limited to changes since the last call.
class Stage {
public:
    explicit Stage(Renderer& renderer) : renderer_(renderer) {}

    /// Returns true if anything changed. Calls `before_scene` before Renderer::set_scene(); after it, no frame may be
    /// unread.
    bool apply(const Document& document, const std::function<void()>& before_scene);
    /// The scene as drawn.
    const Scene& scene() const { return scene_; }
    /// The camera as drawn.
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
    std::optional<Look> applied_;                 ///< empty after a new scene
};

}  // namespace pellucid::viewer
