#include "viewer/document.h"

#include <algorithm>

namespace pellucid::viewer {
namespace {

constexpr std::size_t kMostSteps = 256;

/// Of the old look what has nothing to do with the scene.
void keep(Look& look, const Look& old) {
    look.technique = old.technique;
    look.other = old.other;
    look.divider = old.divider;
    look.parameters = old.parameters;
    look.view = old.view;
    look.overlay = old.overlay;
    look.samples = old.samples;
    look.tonemap = old.tonemap;
    look.exposure_ev = old.exposure_ev;
    look.transport = old.transport;
    look.shadows = old.shadows;
    look.bounces = old.bounces;
    look.environment = old.environment;
    look.environment_rotation_deg = old.environment_rotation_deg;
    look.environment_intensity = old.environment_intensity;
}

}  // namespace

void Document::open(const std::string& source, const cli::SceneArguments& how, std::uint32_t width,
                    std::uint32_t height) {
    Scene scene = cli::load_given_scene(source, how);
    Look next = look_of(scene);
    keep(next, look);
    const Bounds bounds = scene_bounds(scene);
    next.camera =
        scene.cameras.empty() ? framing_orbit(bounds, width, height) : orbit_from_camera(scene.cameras.front(), bounds);
    animations_ = pellucid::animations(scene);
    scene_ = std::move(scene);
    bounds_ = bounds;
    how_ = how;
    look = std::move(next);
    ++scene_number_;
    history_ = {look};
    step_ = 0;
}

void Document::open_environment(const std::string& name_or_file) {
    if (name_or_file != environment_name_) {
        environment_ = load_environment(name_or_file);
        environment_name_ = name_or_file;
        ++environment_number_;
    }
    look.environment = name_or_file;
}

void Document::commit() {
    if (!history_.empty() && history_[step_] == look) return;
    if (!history_.empty()) history_.resize(step_ + 1);
    history_.push_back(look);
    if (history_.size() > kMostSteps) history_.erase(history_.begin());
    step_ = history_.size() - 1;
}

bool Document::go(std::size_t step) {
    Look next = history_[step];
    open_environment(next.environment);
    look = std::move(next);
    step_ = step;
    return true;
}

bool Document::undo() {
    commit();
    return step_ > 0 && go(step_ - 1);
}

bool Document::redo() { return !history_.empty() && step_ + 1 < history_.size() && go(step_ + 1); }

bool Document::fits(const Look& other) const {
    return other.materials.size() == scene_.materials.size() && other.lights.size() == scene_.lights.size() &&
           (!other.animation || *other.animation < animations_.size());
}

}  // namespace pellucid::viewer
