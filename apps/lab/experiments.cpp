#include "lab/experiments.h"

#include "lab/experiment_scenes.h"
#include "lab/ihrke_experiments.h"
#include "lab/kay_greenberg_experiments.h"
#include "lab/light_experiments.h"
#include "lab/thickness_experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace pellucid::cli {
namespace {

constexpr Model kDragon{"dragon", {"photon_dragon.obj", nullptr}};
constexpr Model kHead{"head", {"suzanne.obj", nullptr}};
constexpr Model kFigure{"closed figure", {"homer.obj", nullptr}};
constexpr Model kFiftyThousand{"stand-in for the buddha", {"dragon_vrip_res3.ply", nullptr}};
constexpr Model kPlane{"F-16", {"f16.ply", nullptr}};
constexpr Model kSphere1600{"sphere of 1,600 triangles", {"gen_sphere_1600.obj", nullptr}};
constexpr Model kTeapot{"teapot", {"teapot.obj", nullptr}};

/// Collects the scenes of an experiment, leaving out models that are not there.
class Scenes {
public:
    explicit Scenes(ModelFolder& models) : models_(models) {}

    Scenes& shape(const std::string& label, const std::string& source) {
        all_.push_back({.label = label, .how = {.scene = source, .source = source}});
        return *this;
    }
    Scenes& model(const std::string& label, const Model& model, std::map<std::string, double> published = {}) {
        const std::filesystem::path file = models_.find(model);
        if (file.empty()) return *this;
        all_.push_back({.label = label,
                        .how = {.scene = file.filename().string(), .source = file.string()},
                        .published = std::move(published)});
        return *this;
    }
    Scenes& closed(const std::string& label, const Model& model) {
        const std::size_t before = all_.size();
        this->model(label, model);
        if (all_.size() > before) all_.back().close_holes = true;
        return *this;
    }
    /// Solids in a row behind one another: deeper than wide, so that the camera may stand nearer than usual.
    Scenes& made(const std::string& label, Scene (*make)()) {
        constexpr float kDistance = 3.4f;  // bounding-sphere radii
        all_.push_back({.label = label, .how = {.scene = label, .distance = kDistance}, .make = make});
        return *this;
    }
    std::vector<ExperimentScene> all() { return std::move(all_); }
    /// Every scene once with each index of refraction.
    std::vector<ExperimentScene> with_indices(std::initializer_list<float> indices) {
        std::vector<ExperimentScene> scenes;
        for (const ExperimentScene& scene : all_) {
            for (const float index : indices) {
                scenes.push_back(scene);
                scenes.back().label = fmt::format("{}, index {}", scene.label, index);
                scenes.back().ior = index;
            }
        }
        return scenes;
    }

private:
    ModelFolder& models_;
    std::vector<ExperimentScene> all_;
};

std::vector<ExperimentScene> cow(ModelFolder& models) { return Scenes(models).model("cow", kCow).all(); }

std::vector<ExperimentScene> dragon(ModelFolder& models) { return Scenes(models).model("dragon", kDragon).all(); }

std::vector<ExperimentScene> torus_and_bunny(ModelFolder& models) {
    return Scenes(models).shape("torus", "shape:torus").model("bunny", kBunny).all();
}

std::vector<ExperimentScene> surfaces_with_faults(ModelFolder& models) {
    return Scenes(models)
        .shape("torus", "shape:torus,segments=24,sides=12")
        .shape("goblet", "shape:goblet")
        .shape("hollow sphere", "shape:hollow-sphere")
        .model("cow", kCow)
        .model("bunny", kBunny)
        .all();
}

std::vector<ExperimentScene> models_of_the_thesis(ModelFolder& models) {
    return Scenes(models)
        .shape("sphere", "shape:sphere")
        .shape("goblet", "shape:goblet")
        .shape("torus", "shape:torus")
        .shape("knot", "shape:knot")
        .model("cow", kCow)
        .shape("bottle", "shape:bottle")
        .model("bunny", kBunny)
        .model("head (open)", kHead)
        .closed("head, holes closed", kHead)
        .model("figure (closed)", kFigure)
        .all();
}

std::vector<ExperimentScene> published_indices(ModelFolder& models) {
    return Scenes(models)
        .shape("sphere", "shape:sphere")
        .shape("goblet", "shape:goblet")
        .model("cow", kCow)
        .model("bunny", kBunny)
        .with_indices({1.2f, 1.45f, 1.5f});
}

std::vector<ExperimentScene> many_objects(ModelFolder& models) {
    return Scenes(models)
        .made("cube before a knot", cube_before_knot)
        .made("sphere before a sphere", sphere_before_sphere)
        .made("five objects", five_objects)
        .all();
}

/// Frames per second with two interfaces and with one, and seconds of offline ray tracing.
std::map<std::string, double> wyman(double two_fps, double one_fps, double offline_s) {
    return {{"fps", two_fps}, {"first_fps", one_fps}, {"times_first_fps", two_fps / one_fps}, {"offline_s", offline_s}};
}

std::vector<ExperimentScene> wyman_models(ModelFolder& models) {
    return Scenes(models)
        .model("for buddha", kFiftyThousand, wyman(53.3, 136.8, 121.9))
        .model("cow", kCow, wyman(122.9, 285.7, 31.6))
        .model("F-16", kPlane, wyman(149.2, 395.9, 26.8))
        .model("sphere", kSphere1600, wyman(164.3, 323.5, 6.1))
        .model("teapot", kTeapot, wyman(115.7, 306.9, 49.3))
        .model("dragon, for venus", kDragon, wyman(37.9, 112.2, 147.2))
        .all();
}

/// Table 4.1: frames per second of the thesis, and of ray tracing from 20 units and from 10.
struct ThesisRow {
    const char* label;
    const char* scene;  ///< how the scene's name begins in the suite
    double fps, far_fps, near_fps;
};
constexpr ThesisRow kTable41[] = {{"sphere", "shape:sphere", 153, 112, 56},
                                  {"cow", "cow", 126, 44, 23},
                                  {"torus", "shape:torus", 142, 92, 49},
                                  {"infinity ring", "shape:infinity-ring", 133, 79, 34},
                                  {"bunny", "bunny", 15, 12, 9}};

/// The suite of bench: every model far, then every model near.
std::vector<ExperimentScene> table_4_1(ModelFolder& models) {
    std::vector<ExperimentScene> scenes;
    const std::vector<BenchCase> cases = suite_cases("thesis", models);
    for (const BenchCase& each : cases) {
        const auto found = std::find_if(std::begin(kTable41), std::end(kTable41),
                                        [&](const ThesisRow& row) { return each.scene.starts_with(row.scene); });
        if (found == std::end(kTable41)) throw std::logic_error(each.scene + " is not in table 4.1");
        const ThesisRow& theirs = *found;
        const bool far = each.distance == cases.front().distance;
        const double ray_tracing_fps = far ? theirs.far_fps : theirs.near_fps;
        scenes.push_back(
            {.label = fmt::format("{}, {}", theirs.label, far ? "far" : "near"),
             .how = each,
             .published = {
                 {"fps", theirs.fps}, {"ray_tracing_fps", ray_tracing_fps}, {"ratio", theirs.fps / ray_tracing_fps}}});
    }
    return scenes;
}

constexpr Column kWithin1{"within 1 degree, %", "/within_1deg", 100.0};
constexpr Column kStable{"stable pixels within 1 degree, %", "/within_1deg_stable", 100.0};
constexpr Column kWithin5{"within 5 degrees, %", "/within_5deg", 100.0};
constexpr Column kFlip{"FLIP", "/flip_mean", 1.0, 3};
constexpr Column kRmse{"RMSE", "/rmse", 1.0, 4};
constexpr Column kTriangles{"triangles", "/triangles", 1.0, 0};
constexpr Column kFrame{"frame, ms", "/frame_ms/median"};
constexpr Column kEmbree{"Embree, ms", "/embree_ms"};

/// Accuracy, with what the exact path allows and why pixels were given up.
std::vector<Column> accuracy_columns() {
    return {kTriangles,
            kWithin1,
            kStable,
            kWithin5,
            {"exact against itself, %", "/self_within_1deg", 100.0},
            kFlip,
            {"ok, %", "/status/ok", 100.0},
            {"missing layer, %", "/status/missing_layer", 100.0},
            {"left screen, %", "/status/left_screen", 100.0},
            {"step limit, %", "/status/step_limit", 100.0},
            {"event limit, %", "/status/event_limit", 100.0}};
}

std::vector<Column> with_first(Column first, std::vector<Column> others) {
    others.insert(others.begin() + 1, first);
    return others;
}

ExperimentSpec wang_search_step() {
    ExperimentSpec spec{
        .name = "wang-search-step",
        .source = "Wang 2014, section 3.5.3: SIZE of the linear search",
        .varied =
            "SIZE, the step of the search, 1/5, 1/50 and 1/500 of a depth range: of the object's box, or "
            "from the eye to the end of the glass; with and without the search for what a step beyond the "
            "silhouette has passed",
        .environment = "sky",
        .scenes = cow,
        .columns = accuracy_columns(),
        .plots = {{"Accuracy over SIZE", "%", false, {kWithin1, kStable}}}};
    for (const bool silhouettes : {true, false}) {
        for (const bool of_box : {true, false}) {
            for (const int steps : {5, 50, 500}) {
                spec.variants.push_back({.label = fmt::format("{}1/{} {}", silhouettes ? "" : "no silhouettes, ", steps,
                                                              of_box ? "of the box" : "from the eye"),
                                         .technique = "wang-2014",
                                         .parameters = {{"steps", double(steps)},
                                                        {"size-range", of_box ? 0.0 : 1.0},
                                                        {"silhouettes", silhouettes ? 1.0 : 0.0}}});
            }
        }
    }
    return spec;
}

ExperimentSpec wang_environment() {
    ExperimentSpec spec{.name = "wang-environment",
                        .source = "Wang 2014, section 4.5, figure 4.23: resolution of the environment map",
                        .varied =
                            "width of the environment map in texels (its height is half of that), against the "
                            "procedural environment that it was made from",
                        .environment = "checker",
                        .truth = {"procedural", "wang-2014"},
                        .scenes = torus_and_bunny,
                        .zoom = true,
                        .columns = {kFlip, kRmse},
                        .plots = {{"FLIP over the width of the map", "", false, {kFlip}},
                                  {"RMSE over the width of the map", "", false, {kRmse}}}};
    for (const int width : {256, 512, 1024})
        spec.variants.push_back(
            {.label = fmt::format("{} texels", width), .technique = "wang-2014", .map_width = width});
    return spec;
}

ExperimentSpec wang_footprint() {
    ExperimentSpec spec{.name = "wang-footprint",
                        .source = "Wang 2014, chapter 5: filtered textures by the depth of refraction, its future work",
                        .varied = "samples per pixel, and directions along a side of a pixel's footprint",
                        .environment = "checker",
                        .truth = {.label = "256 samples", .technique = "wang-2014", .samples = 256},
                        .scenes = torus_and_bunny,
                        .zoom = true,
                        .columns = {kFlip, kRmse},
                        .plots = {{"FLIP", "", false, {kFlip}}}};
    for (const std::uint32_t samples : {1u, 4u}) {
        for (const int side : {0, 4, 8}) {
            const std::string footprint = side == 0 ? "one direction" : fmt::format("footprint {0}x{0}", side);
            spec.variants.push_back(
                {.label = fmt::format("{} sample{}, {}", samples, samples == 1 ? "" : "s", footprint),
                 .technique = "wang-2014",
                 .parameters = {{"footprint", double(side)}},
                 .samples = samples});
        }
    }
    return spec;
}

ExperimentSpec wang_layers() {
    ExperimentSpec spec{.name = "wang-layers",
                        .source = "Wang 2014, sections 3.1.2 and 3.4: depth layers",
                        .varied = "number of layers",
                        .scenes = dragon,
                        .timed = true,
                        .columns = {kTriangles, kWithin1, kStable, kWithin5, kFlip, kFrame, kEmbree},
                        .plots = {{"Accuracy over layers", "%", false, {kWithin1, kStable}},
                                  {"Time over layers", "ms", false, {kFrame}}}};
    for (const int layers : {2, 4, 6, 8})
        spec.variants.push_back({fmt::format("{} layers", layers), "wang-2014", {{"layers", double(layers)}}});
    return spec;
}

ExperimentSpec wang_exits() {
    ExperimentSpec spec{.name = "wang-exits",
                        .source = "Wang 2014, sections 3.5.1 and 5.2: exits of rays below a fault",
                        .varied = "where the exit of a ray is searched",
                        .scenes = surfaces_with_faults,
                        .timed = true,
                        .columns = {kTriangles,
                                    kWithin1,
                                    kStable,
                                    kWithin5,
                                    {"missing layer, %", "/status/missing_layer", 100.0},
                                    {"event limit, %", "/status/event_limit", 100.0},
                                    kFrame,
                                    kEmbree,
                                    {"times as fast as the first", "/times_first_fps", 1.0, 2}},
                        .plots = {{"Stable pixels within 1 degree", "%", true, {kStable}}}};
    const auto add = [&](const char* label, int below_faults, bool front_exits, bool steep_walls) {
        spec.variants.push_back({.label = label,
                                 .technique = "wang-2014",
                                 .parameters = {{"below-faults", double(below_faults)},
                                                {"front-exits", front_exits ? 1.0 : 0.0},
                                                {"steep-walls", steep_walls ? 1.0 : 0.0}}});
    };
    add("waits below faults (3.5.1)", 0, false, false);
    add("layer k+2 below faults (5.2)", 1, false, false);
    add("crosses on from its start", 2, false, false);
    add("layers 1 and 3 after reflection", 0, true, false);
    add("jumps to the outside are walls", 0, false, true);
    add("5.2, layers 1 and 3, walls", 1, true, true);
    return spec;
}

ExperimentSpec wang_steps() {
    return {.name = "wang-steps",
            .source = "Wang 2014, section 4.4: steps of the search, two searches at best, (3+1)(m+n) steps at worst",
            .varied = "model, and search of the text or of ours",
            .variants = {{"as in 3.5",
                          "wang-2014",
                          {{"count-steps", 1.0}, {"below-faults", 0.0}, {"front-exits", 0.0}, {"steep-walls", 0.0}}},
                         {"defaults", "wang-2014", {{"count-steps", 1.0}}}},
            .scenes = models_of_the_thesis,
            .columns = {kTriangles,
                        kStable,
                        {"mean steps, (m+n)", "/searches/mean", 1.0, 2},
                        {"95% of the pixels below, (m+n)", "/searches/p95", 1.0, 2},
                        {"largest, (m+n)", "/searches/largest", 1.0, 2},
                        {"pixels beyond 4 (m+n), %", "/searches/beyond_worst", 100.0, 3}},
            .plots = {{"Mean steps of a pixel, in (m+n)", "", true, {{"mean", "/searches/mean", 1.0, 2}}}},
            .remark = "n is 50 linear, m 8 binary steps. A search ends at its hit, so it takes fewer than (m+n)."};
}

ExperimentSpec interfaces() {
    return {.name = "interfaces",
            .source = "Wang 2014, section 4.2, figures 4.3 to 4.17: one, two and four interfaces",
            .varied = "techniques, by the number of interfaces that they follow",
            .environment = "sky",
            .variants = {{"one interface", "one-interface"},
                         {"two, Wyman 2005", "wyman-2005"},
                         {"two, Oliveira and Brauwers 2007", "oliveira-brauwers-2007"},
                         {"two, the same with the first back face", "oliveira-brauwers-2007", {{"back-face", 0.0}}},
                         {.label = "four, Wang 2014",
                          .technique = "wang-2014",
                          .parameters = {{"layers", 4.0}},
                          .analysis = true}},
            .scenes = models_of_the_thesis,
            .columns = accuracy_columns(),
            .plots = {{"Within 1 degree of exact", "%", true, {kWithin1}}},
            .remark =
                "The analysis view: red up to two interfaces, blue more, green total internal reflection, grey "
                "where the technique gave up."};
}

ExperimentSpec wang_refractions() {
    ExperimentSpec spec{
        .name = "wang-refractions",
        .source = "Wang 2014, section 3.1.2, figure 3.4: four and six refractions of a traced dragon",
        .varied = "interface events that a traced path may have",
        .scenes = dragon,
        .zoom = true,
        .columns = {kTriangles, {"paths that leave the glass, %", "/status/ok", 100.0}, kWithin1, kFlip, kRmse},
        .plots = {{"Paths that leave the glass", "%", false, {{"all", "/status/ok", 100.0}}}}};
    for (const int events : {4, 6, 8, 16})
        spec.variants.push_back({fmt::format("{} events", events), "reference", {{"events", double(events)}}});
    return spec;
}

ExperimentSpec published_index() {
    return {.name = "index",
            .source = "Wyman 2005 (index 1.2) and Wang 2014 (1.45): published techniques at the published indices",
            .varied = "index of refraction, and technique",
            .variants = {{"one interface", "one-interface"},
                         {"Kay and Greenberg 1979", "kay-greenberg-1979"},
                         {"Wyman 2005", "wyman-2005"},
                         {"Oliveira and Brauwers 2007", "oliveira-brauwers-2007"},
                         {"the same, first back face", "oliveira-brauwers-2007", {{"back-face", 0.0}}},
                         {"Wang 2014", "wang-2014"}},
            .scenes = published_indices,
            .columns = {kTriangles, kWithin1, kStable, kWithin5, kFlip, {"ok, %", "/status/ok", 100.0}}};
}

ExperimentSpec wyman_speed() {
    return {.name = "wyman-speed",
            .source = "Wyman 2005, table of speeds: two interfaces beside one",
            .varied = "technique and model, at 1024x1024",
            .size = {1024, 1024},
            .variants = {{"one interface", "one-interface"}, {"two interfaces, Wyman 2005", "wyman-2005"}},
            .scenes = wyman_models,
            .timed = true,
            .columns = {kTriangles,
                        kFrame,
                        {"frames/s", "/fps"},
                        {"times as fast as with one", "/times_first_fps", 1.0, 2},
                        kEmbree,
                        {"exact trace, ms", "/exact_ms", 1.0, 0},
                        {"paper: one, frames/s", "/published/first_fps"},
                        {"paper: two, frames/s", "/published/fps"},
                        {"paper: times as fast as with one", "/published/times_first_fps", 1.0, 2},
                        {"paper: offline, s", "/published/offline_s"}},
            .plots = {{"Two interfaces: times as fast as with one",
                       "",
                       true,
                       {{"ours", "/times_first_fps", 1.0, 2}, {"paper", "/published/times_first_fps", 1.0, 2}}}},
            .remark =
                "The models are ours, of counts like the paper's. Embree traces every interface of the same view "
                "in single precision on all cores; the exact trace is that of technique `reference`."};
}

ExperimentSpec wang_table_4_1() {
    return {.name = "wang-table-4-1",
            .source = "Wang 2014, section 4.4, table 4.1: against ray tracing, far and near",
            .varied =
                "model and distance (10 and 5 bounding-sphere radii; the thesis has 20 and 10 of a unit that it "
                "does not name)",
            .variants = {{"wang-2014", "wang-2014"}},
            .scenes = table_4_1,
            .timed = true,
            .columns = {kTriangles,
                        {"glass pixels", "/covered", 1.0, 0},
                        kStable,
                        kFrame,
                        {"frames/s", "/fps"},
                        kEmbree,
                        {"times as fast as Embree", "/ratio_embree", 1.0, 2},
                        {"thesis: frames/s", "/published/fps", 1.0, 0},
                        {"thesis: ray tracing, frames/s", "/published/ray_tracing_fps", 1.0, 0},
                        {"thesis: times as fast", "/published/ratio", 1.0, 2}},
            .plots = {{"Times as fast as ray tracing",
                       "",
                       true,
                       {{"ours, against Embree", "/ratio_embree", 1.0, 2},
                        {"thesis, against OptiX", "/published/ratio", 1.0, 2}}}},
            .remark = "Ours and Embree ran in turn on the machine named below; the thesis used one GPU for both."};
}

ExperimentSpec wang_many_objects() {
    return {.name = "wang-many-objects",
            .source = "Wang 2014, section 4.3, figures 4.18 to 4.21: several objects behind one another",
            .varied = "the scene",
            .environment = "sky",
            .variants = {{.label = "wang-2014", .technique = "wang-2014", .analysis = true}},
            .scenes = many_objects,
            .columns = with_first({"objects", "/objects", 1.0, 0}, accuracy_columns()),
            .remark =
                "The analysis view: red up to two interfaces, blue more, green total internal reflection, grey "
                "where the technique gave up."};
}

}  // namespace

std::span<const ExperimentSpec> experiments() {
    static const std::vector<ExperimentSpec> all = {wang_search_step(),
                                                    wang_environment(),
                                                    wang_footprint(),
                                                    wang_layers(),
                                                    wang_exits(),
                                                    wang_steps(),
                                                    wang_refractions(),
                                                    published_index(),
                                                    interfaces(),
                                                    wyman_speed(),
                                                    wang_table_4_1(),
                                                    wang_many_objects(),
                                                    chen_error(),
                                                    chen_speed(),
                                                    ihrke_rays(),
                                                    ihrke_light(),
                                                    ihrke_reflections(),
                                                    kay_greenberg_transparency(),
                                                    kay_greenberg_background()};
    return all;
}

const ExperimentSpec& find_experiment(const std::string& name) {
    std::vector<std::string_view> known;
    for (const ExperimentSpec& spec : experiments()) {
        if (spec.name == name) return spec;
        known.emplace_back(spec.name);
    }
    throw unknown_name("experiment", name, known);
}

}  // namespace pellucid::cli
