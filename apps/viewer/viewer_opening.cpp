// The part of the viewer that opens files.
#include "viewer/viewer.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pellucid::viewer {
namespace {

bool is_environment(const std::string& file) {
    const std::string extension = lower_extension(file);
    return extension == ".hdr" || extension == ".exr";
}

}  // namespace

void Viewer::open(const std::string& source, Opening opening) {
    panels_.clear_message();
    if (is_environment(source)) {
        open_environment(source, std::move(opening.failed));
        return;
    }
    opening_ = std::move(opening);
    scene_load_.start(source, [source, how = opening_.how] { return load_document_scene(source, how); });
}

void Viewer::open_environment(const std::string& name_or_file, OnFailure failed) {
    panels_.clear_message();
    environment_failed_ = std::move(failed);
    document_.look.environment = name_or_file;
}

void Viewer::cancel_loading() {
    scene_load_.cancel();
    environment_load_.cancel();
    environment_failed_ = {};
    document_.look.environment = document_.environment_name();
    turns_to_draw_ = kLateTurns;
}

bool Viewer::loading() const {
    return scene_load_.busy() || document_.look.environment != document_.environment_name();
}

std::optional<LoadingProgress> Viewer::progress() const {
    if (!loading()) return std::nullopt;
    if (scene_load_.busy()) return LoadingProgress{scene_load_.name(), scene_load_.seconds()};
    return LoadingProgress{document_.look.environment, environment_load_.seconds()};
}

/// Shows files whose loading has finished since the last turn.
void Viewer::take_loaded() {
    load_environment();
    if (!scene_load_.ready()) return;
    const Opening opening = std::exchange(opening_, {});  // its functions may open another file
    attempt(
        [&] {
            show(scene_load_.take());
            if (opening.then) opening.then();
        },
        opening.failed);
}

/// Loads the environment named by the look, which undo may change too.
void Viewer::load_environment() {
    const std::string wanted = document_.look.environment;
    if (wanted == document_.environment_name()) return;
    if (!environment_load_.busy() || environment_load_.name() != wanted)
        environment_load_.start(wanted, [wanted] { return load_document_environment(wanted); });
    if (!environment_load_.ready()) return;
    const OnFailure failed = std::exchange(environment_failed_, {});
    attempt(
        [&] {
            LoadedEnvironment loaded = environment_load_.take();
            document_.show(wanted, std::move(loaded.environment));
            if (!loaded.warning.empty()) panels_.say(loaded.warning, false);
        },
        [&](const std::string& why) {
            document_.look.environment = document_.environment_name();
            failed ? failed(why) : panels_.say(why, true);
        });
}

void Viewer::show(LoadedScene loaded) {
    const vk::Extent2D extent = window_.extent();
    Document before = document_;
    document_.show(std::move(loaded), std::max(1u, extent.width), std::max(1u, extent.height));
    try {
        stage_.apply(document_, [&] { finish_pictures(); });
    } catch (...) {
        document_ = std::move(before);  // the device cannot allocate the new scene
        throw;
    }
    ++revision_;
    ray_.reset();
    const Scene& scene = document_.scene();
    window_.set_title(fmt::format("{} - Pellucid", std::filesystem::path(scene.source).filename().string()));
    if (scene.warnings.size() == 1) panels_.say(scene.warnings.front(), false);
    if (scene.warnings.size() > 1)
        panels_.say(fmt::format("{} (and {} more warnings)", scene.warnings.front(), scene.warnings.size() - 1), false);
}

}  // namespace pellucid::viewer
