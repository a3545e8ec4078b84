#include "lab/dataset_sample.h"

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::cli {
namespace {

RenderSettings settings_of(const Recipe& recipe) {
    RenderSettings settings;
    settings.width = std::uint32_t(recipe.width);
    settings.height = std::uint32_t(recipe.height);
    settings.technique = recipe.technique;
    settings.samples = std::uint32_t(recipe.samples);
    return settings;
}

ExactSettings exact_settings(const Recipe& recipe) {
    ExactSettings settings;
    settings.width = std::uint32_t(recipe.width);
    settings.height = std::uint32_t(recipe.height);
    settings.max_events = std::uint32_t(recipe.max_events);
    return settings;
}

RenderResult draw(Renderer& renderer, const Scene& scene, const DatasetScene& made, const Recipe& recipe) {
    renderer.set_scene(scene);
    renderer.set_environment(made.environment);
    renderer.set_camera(made.camera);
    return renderer.render(settings_of(recipe));
}

/// The first object that a path meets, of glass or opaque; -1: none.
int first_object(const SurfacePath& path) { return path.path.events > 0 ? path.first.object : path.path.object; }

int instance_of(const DatasetScene& made, int object) {
    for (std::size_t i = 0; i < made.placed.size(); ++i) {
        const int index = object - made.placed[i].first_object;
        if (index >= 0 && index < made.placed[i].object_count) return int(i) + 1;
    }
    return 0;
}

}  // namespace

DatasetSample make_sample(const Recipe& recipe, const DatasetScene& made, Renderer& renderer, std::uint32_t threads) {
    DatasetSample sample;
    sample.with_glass = draw(renderer, made.scene, made, recipe);
    sample.without_glass = draw(renderer, made.background, made, recipe);
    const ExactSettings settings = exact_settings(recipe);
    sample.paths = SurfaceTracer(made.scene, threads).trace(made.camera, settings);
    sample.background = Tracer(made.background, {.threads = threads}).exact(made.camera, settings);
    std::vector<RefractedPath> paths;
    for (const SurfacePath& path : sample.paths) {
        paths.push_back(path.path);
        sample.instances.push_back(instance_of(made, first_object(path)));
    }
    sample.flow = refractive_flow(paths, made.camera, settings.width, settings.height);
    ExactSettings one_event = settings;
    one_event.max_events = 1;
    for (const Scene& alone : made.alone) {
        std::vector<std::uint8_t>& mask = sample.whole_masks.emplace_back();
        for (const RefractedPath& path : Tracer(alone, {.threads = threads}).exact(made.camera, one_event))
            mask.push_back(path.events > 0 || path.object >= 0 ? 1 : 0);
    }
    return sample;
}

std::string sample_name(std::uint64_t image) { return fmt::format("{:06}", image); }

}  // namespace pellucid::cli
