#include "lab/thickness_compare.h"

#include "options/progress_bar.h"
#include "options/unread_scenes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <set>

namespace pellucid::cli {
namespace {

/// One scene, one light, one camera.
struct ComparedView {
    std::string scene;
    std::uint32_t light;
    std::string name;
    std::uint64_t triangles;
    Image truth;
    float full;  ///< m, end of the pictures' scale
};

class ThicknessTable {
public:
    explicit ThicknessTable(const ThicknessComparison& comparison)
        : comparison_(comparison), renderer_(device_options(comparison.device)), unread_(comparison.scenes.size()) {
        std::tie(width_, height_) = parse_size(comparison.size);
        if (comparison.pictures) std::filesystem::create_directories(*comparison.pictures);
        json_ = {{"device", renderer_.device().name},
                 {"driver", renderer_.device().driver},
                 {"version", version()},
                 {"width", width_},
                 {"height", height_},
                 {"layers", comparison.thickness.layers},
                 {"light_map", comparison.thickness.resolution},
                 {"runs", nlohmann::ordered_json::array()}};
        comparison_.console.print("{:<26} {:>5} {:<7} {:<23} {:>8} {:>10} {:>10} {:>10} {:>9} {:>7}\n", "scene",
                                  "light", "view", "method", "error%", "mean m", "95% m", "largest m", "time ms",
                                  "passes");
    }

    void add_scene(const std::string& name) {
        Scene scene;
        const auto load = [&] { scene = load_given_scene(name, comparison_.how, comparison_.console); };
        if (!unread_.read(name, load)) return;
        warnings_.insert(scene.warnings.begin(), scene.warnings.end());
        if (scene.lights.empty()) throw Error(fmt::format("{}: there is no light; give one with --add-light", name));
        renderer_.set_scene(scene);
        const ThicknessTracer tracer(scene, comparison_.device.threads);
        for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
            for (const NamedCamera& from : cameras_about_light(scene, scene.lights[light], width_, height_)) {
                ProgressBar bar(comparison_.console, fmt::format("{}, light {}, {}, exact", name, light, from.name));
                renderer_.set_camera(from.camera);
                ComparedView view{name,
                                  light,
                                  from.name,
                                  scene.triangle_count(),
                                  tracer.trace(from.camera, width_, height_, light, bar.progress()),
                                  0.0f};
                bar.clear();
                view.full = largest_value(view.truth);
                write_picture(view, "exact", view.truth);
                for (const ThicknessMethodInfo& info : thickness_methods()) add_method(view, info);
            }
        }
    }

    void finish() {
        json_["warnings"] = warnings_;
        for (const std::string& error : unread_.errors()) json_["warnings"].push_back(error);
        if (comparison_.json) write_json(*comparison_.json, json_);
        comparison_.console.warn({warnings_.begin(), warnings_.end()});
        check_validation(renderer_);
        unread_.finish();
    }

private:
    void add_method(const ComparedView& view, const ThicknessMethodInfo& info) {
        ProgressBar bar(comparison_.console, fmt::format("{}, {}", view.scene, info.name));
        const ThicknessRequest request{
            .width = width_,
            .height = height_,
            .settings = {info.method, comparison_.thickness.layers, comparison_.thickness.resolution},
            .light = view.light,
            .progress = bar.progress()};
        renderer_.measure_thickness(request);  // shaders are compiled in the first
        const ThicknessResult result = renderer_.measure_thickness(request);
        bar.clear();
        for (const std::string& warning : result.warnings) warnings_.insert(fmt::format("{}: {}", info.name, warning));
        if (result.cut_rays > 0)
            warnings_.insert(
                fmt::format("{}: {} pixels of the view from {}: light meets more surfaces than --thickness-layers",
                            info.name, result.cut_rays, view.name));
        Image difference;
        const ThicknessError error = thickness_error(view.truth, result.thickness, &difference);
        comparison_.console.print("{:<26} {:>5} {:<7} {:<23} {:>8.3f} {:>10.3g} {:>10.3g} {:>10.3g} {:>9.1f} {:>7}\n",
                                  std::filesystem::path(view.scene).filename().string(), view.light, view.name,
                                  info.name, 100.0 * error.relative, error.mean, error.p95, error.largest,
                                  result.wall_ms, result.geometry_passes);
        write_picture(view, std::string(info.name), result.thickness);
        for (std::size_t i = 0; i < difference.pixels.size(); ++i) {
            if (view.truth.pixels[i] < 0.0f && result.thickness.pixels[i] < 0.0f)
                difference.pixels[i] = kNotTranslucent;
        }
        // A tenth of the scale of the thickness.
        write_picture(view, fmt::format("{}-error", info.name), difference, 0.1f);
        json_["runs"].push_back({{"scene", view.scene},
                                 {"light", view.light},
                                 {"view", view.name},
                                 {"triangles", view.triangles},
                                 {"method", info.name},
                                 {"points", error.points},
                                 {"unmatched", error.unmatched},
                                 {"relative_error", error.relative},
                                 {"mean_m", error.mean},
                                 {"p95_m", error.p95},
                                 {"largest_m", error.largest},
                                 {"cut_rays", result.cut_rays},
                                 {"geometry_passes", result.geometry_passes},
                                 {"light_views", result.light_views},
                                 {"wall_ms", result.wall_ms}});
    }

    void write_picture(const ComparedView& view, const std::string& what, const Image& values, float share = 1.0f) {
        if (!comparison_.pictures) return;
        std::string stem = std::filesystem::path(view.scene).stem().string();
        std::replace_if(
            stem.begin(), stem.end(), [](char c) { return c == ':' || c == ',' || c == '='; }, '-');
        const std::string light = view.light > 0 ? fmt::format("-light{}", view.light) : "";
        write_image(
            std::filesystem::path(*comparison_.pictures) / fmt::format("{}{}-{}-{}.png", stem, light, view.name, what),
            color_thickness(values, share * view.full));
    }

    const ThicknessComparison& comparison_;
    Renderer renderer_;
    std::uint32_t width_ = 0, height_ = 0;
    nlohmann::ordered_json json_;
    std::set<std::string> warnings_;
    UnreadScenes unread_;
};

}  // namespace

void compare_thickness(const ThicknessComparison& comparison) {
    if (comparison.json) check_outputs({*comparison.json}, comparison.scenes);
    ThicknessTable table(comparison);
    for (const std::string& scene : comparison.scenes) table.add_scene(scene);
    table.finish();
}

}  // namespace pellucid::cli
