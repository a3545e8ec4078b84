#include "viewer/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <utility>

namespace pellucid::viewer {
namespace {

constexpr std::size_t kMostSteps = 256;

/// Copies from the old look all that is independent of the scene.
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

LoadedScene load_document_scene(const std::string& source, const cli::SceneArguments& how) try {
    LoadedScene loaded{.scene = cli::load_given_scene(source, how, {.quiet = true}), .how = how};
    loaded.bounds = scene_bounds(loaded.scene);
    loaded.animations = pellucid::animations(loaded.scene);
    return loaded;
} catch (const std::bad_alloc&) {
    throw Error(fmt::format("{}: there is not enough memory", source));
}

LoadedEnvironment load_document_environment(const std::string& name_or_file) try {
    LoadedEnvironment loaded;
    loaded.environment = load_environment(name_or_file, &loaded.warning);
    return loaded;
} catch (const std::bad_alloc&) {
    throw Error(fmt::format("{}: there is not enough memory", name_or_file));
}

void Document::show(LoadedScene loaded, std::uint32_t width, std::uint32_t height) {
    loaded_ = std::move(loaded);
    Look next = look_of(scene());
    keep(next, look);
    next.camera = scene().cameras.empty() ? framing_orbit(bounds(), width, height)
                                          : orbit_from_camera(scene().cameras.front(), bounds());
    look = std::move(next);
    ++scene_number_;
    history_ = {look};
    step_ = 0;
}

void Document::show(std::string name, Environment environment) {
    environment_ = std::move(environment);
    environment_name_ = std::move(name);
    ++environment_number_;
}

void Document::commit() {
    if (!history_.empty() && history_[step_] == look) return;
    if (!history_.empty()) history_.resize(step_ + 1);
    history_.push_back(look);
    if (history_.size() > kMostSteps) history_.erase(history_.begin());
    step_ = history_.size() - 1;
}

bool Document::undo() {
    commit();
    if (step_ == 0) return false;
    look = history_[--step_];
    return true;
}

bool Document::redo() {
    if (step_ + 1 >= history_.size()) return false;
    look = history_[++step_];
    return true;
}

bool Document::fits(const Look& other) const {
    return other.materials.size() == scene().materials.size() && other.lights.size() == scene().lights.size() &&
           (!other.animation || *other.animation < animations().size()) &&
           (other.file_camera.empty() ||
            std::ranges::any_of(scene().cameras, [&](const Camera& each) { return each.name == other.file_camera; }));
}

}  // namespace pellucid::viewer
