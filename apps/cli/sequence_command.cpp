#include "commands.h"
#include "options/arguments.h"
#include "options/help.h"
#include "options/options.h"
#include "options/progress_bar.h"
#include "render_options.h"
#include "sequence/frame_claims.h"
#include "sequence/frames.h"
#include "sequence/keyed_text.h"
#include "sequence/slurm_script.h"

#include <pellucid/file.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;
using sequence::FilePattern;
using sequence::Frames;
using sequence::KeyedText;

constexpr std::size_t kMostTasks = 1000;  ///< that Slurm allows in one array where it is not told otherwise

struct SequenceArguments {
    RenderArguments image;  ///< of a frame
    std::optional<std::string> frames;
    double fps = 24.0;
    std::vector<std::string> camera_keys;
    std::vector<std::string> light_keys;
    bool gather = false;
    std::optional<std::string> slurm;
    std::size_t tasks = kMostTasks;
    std::vector<std::string> given;  ///< options that decide what frames show, as typed
};

std::optional<KeyedText> keyed(const std::string& what, const std::vector<std::string>& keys) {
    if (keys.empty()) return std::nullopt;
    return KeyedText(what, keys);
}

/// Files and keys of a sequence.
struct Plan {
    explicit Plan(const SequenceArguments& a)
        : files("--output", a.image.output), camera(keyed("--camera-at", a.camera_keys)),
          light(keyed("--light-at", a.light_keys)) {
        check_picture_name(a.image);
        for (const std::string& text : a.image.aovs) {
            const auto [name, file] = parse_aov(text);
            aovs.push_back({name, FilePattern("--aov", file)});
        }
    }

    FilePattern files;
    std::vector<std::pair<std::string, FilePattern>> aovs;
    std::optional<KeyedText> camera, light;
};

/// Frames that are asked for; without --frames up to the end of the animation or the last key.
Frames wanted_frames(const SequenceArguments& a, const Plan& plan, const Scene& scene) {
    if (a.frames) return sequence::parse_frames("--frames", *a.frames);
    long last = -1;
    if (plan.camera) last = std::max(last, plan.camera->last_frame());
    if (plan.light) last = std::max(last, plan.light->last_frame());
    const std::vector<AnimationInfo> known = animations(scene);
    if (!known.empty()) {
        const std::size_t index = a.image.how.animation ? find_animation(scene, *a.image.how.animation) : 0;
        last = std::max(last, std::lround(std::floor(known[index].duration_s * a.fps + 1e-6)));
    }
    if (last < 0)
        throw Error(fmt::format("{}: is not animated; give --frames A..B, --camera-at or --light-at", a.image.scene));
    return sequence::parse_frames("--frames", fmt::format("0..{}", last));
}

Frames missing_of(const Frames& frames, const FilePattern& files) {
    Frames missing;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(missing),
                 [&](long frame) { return !sequence::is_written(files.file(frame)); });
    return missing;
}

/// The options that all frames of a sequence have are kept beside them: frames of others are no continuation.
void check_settings(const SequenceArguments& a, const Plan& plan) {
    const fs::path file = plan.files.beside("sequence", ".json");
    const nlohmann::ordered_json settings{{"version", version()}, {"options", a.given}};
    if (!sequence::is_written(file)) return write_json(file.string(), settings);
    std::ifstream stream(file);
    const auto kept = nlohmann::ordered_json::parse(stream, nullptr, false);
    if (kept == settings) return;
    throw Error(
        fmt::format("{}: these frames have other options or another version; remove them and this file, or "
                    "give another --output",
                    file.string()));
}

/// The scene at a frame. Loaded anew for each where it is animated, so that a frame is what `render --time` shows.
class SceneOfFrames {
public:
    explicit SceneOfFrames(const SequenceArguments& arguments, const Plan& plan)
        : a_(arguments), plan_(plan), rest_(load_given_scene(a_.image.scene, a_.image.how, a_.image.console)) {}

    const Scene& rest() const { return rest_; }
    Scene at(long frame) const {
        SceneArguments how = a_.image.how;
        Scene scene;
        if (rest_.rig) {
            how.time_s = how.time_s.value_or(0.0) + double(frame) / a_.fps;
            scene = load_given_scene(a_.image.scene, how, Console{.quiet = true});
        } else {
            scene = rest_;
        }
        if (plan_.light) {
            TranslucencyArguments light;
            light.lights = {plan_.light->at(frame)};
            scene.lights.push_back(parse_lights(light, scene.origin).front());
        }
        return scene;
    }

private:
    const SequenceArguments& a_;
    const Plan& plan_;
    const Scene rest_;
};

/// Each kind of warning once: those of frames differ in numbers.
class Warnings {
public:
    explicit Warnings(const Console& console) : console_(console) {}
    void show(const std::string& frame, const std::vector<std::string>& warnings) {
        for (const std::string& warning : warnings) {
            std::string kind = warning;
            std::erase_if(kind, [](unsigned char c) { return std::isdigit(c) != 0; });
            if (seen_.insert(kind).second) console_.warn({frame + warning});
        }
    }

private:
    const Console& console_;
    std::set<std::string> seen_;
};

/// Renders frames with one renderer. Each starts from the scene alone, so that none depends on those before it.
class FrameRenderer {
public:
    FrameRenderer(const SequenceArguments& arguments, const Plan& plan, const SceneOfFrames& scenes, Warnings& warnings)
        : a_(arguments), plan_(plan), scenes_(scenes), warnings_(warnings), settings_(render_settings(arguments.image)),
          renderer_(device_options(arguments.image.device)) {
        std::string warning;
        renderer_.set_environment(load_given_environment(a_.image.environment, warning));
        if (!warning.empty()) warnings_.show("", {warning});
    }

    void render(long frame, const Progress& progress) {
        const Scene scene = scenes_.at(frame);
        renderer_.set_scene(scene);
        renderer_.set_camera(camera_at(frame, scene));
        settings_.progress = progress;
        const RenderResult result = renderer_.render(settings_);
        for (const auto& [name, files] : plan_.aovs) write_image(files.file(frame), result.aovs.at(name));
        // The image comes last: it says that the frame is done.
        write_picture(plan_.files.file(frame).string(), a_.image, result);
        warnings_.show(fmt::format("frame {}: ", frame), result.warnings);
        check_validation(renderer_);
    }

private:
    /// A camera of the file moves as the file says. Others keep to the bounds of the scene at rest, lest they move with it.
    Camera camera_at(long frame, const Scene& scene) const {
        const Scene& rest = scenes_.rest();
        RenderArguments image = a_.image;
        if (plan_.camera) image.camera = plan_.camera->at(frame);
        const bool of_the_file = image.camera ? !image.camera->starts_with("orbit:") : !scene.cameras.empty();
        if (of_the_file) return chosen_camera(image, settings_, scene).value_or(scene.cameras.front());
        const std::optional<Camera> chosen = chosen_camera(image, settings_, rest);
        Camera camera =
            chosen ? *chosen
                   : framing_camera(scene_bounds(rest), settings_.width, settings_.height, Camera{}.vertical_fov);
        camera.world_from_view[3] += glm::vec4(rest.origin - scene.origin, 0.0);
        return camera;
    }

    const SequenceArguments& a_;
    const Plan& plan_;
    const SceneOfFrames& scenes_;
    Warnings& warnings_;
    RenderSettings settings_;
    Renderer renderer_;
};

struct Outcome {
    std::size_t rendered = 0;
    std::map<long, std::string> failures;  ///< frame and cause
};

Outcome render_missing(const Frames& missing, const SequenceArguments& a, const Plan& plan,
                       const SceneOfFrames& scenes) {
    const Console& console = a.image.console;
    Outcome outcome;
    Warnings warnings(console);
    FrameRenderer renderer(a, plan, scenes, warnings);
    sequence::FrameClaims claims(plan.files.beside("sequence", ".lock"));
    ProgressBar bar(console, "frames");
    std::size_t done = 0;
    const auto make = [&](long frame) {
        const fs::path file = plan.files.file(frame);
        if (!sequence::is_written(file)) {
            const auto begin = std::chrono::steady_clock::now();
            try {
                renderer.render(frame,
                                [&](double share) { bar.show((double(done) + share) / double(missing.size())); });
                ++outcome.rendered;
                console.report(
                    fmt::format("frame {}: {:.2f} s", frame,
                                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
            } catch (const Error& error) {
                outcome.failures[frame] = error.what();
            }
        }
        claims.release(frame);
        bar.show(double(++done) / double(missing.size()));
    };
    Frames of_others;
    for (const long frame : missing) {
        if (claims.claim(frame))
            make(frame);
        else
            of_others.push_back(frame);
    }
    for (const long frame : of_others) {
        claims.claim_in_turn(frame);
        make(frame);
    }
    if (!claims.has_locks())
        console.warn({fmt::format("{}: the file system has no locks; processes that share frames may render them twice",
                                  plan.files.beside("sequence", ".lock").string())});
    return outcome;
}

void report_frames(const SequenceArguments& a, std::size_t frames, const Outcome& outcome) {
    a.image.console.print("{} frames: {} rendered, {} were there\n", frames, outcome.rendered,
                          frames - outcome.rendered - outcome.failures.size());
    if (outcome.failures.empty()) return;
    Frames failed;
    for (const auto& [frame, cause] : outcome.failures) failed.push_back(frame);
    throw FramesMissing(fmt::format("{} of {} frames are missing: {}; frame {}: {}", failed.size(), frames,
                                    sequence::format_frames(failed), failed.front(), outcome.failures.begin()->second));
}

void write_slurm_script(const SequenceArguments& a, const Frames& missing) {
    if (missing.empty()) return a.image.console.print("no frame is missing; {} was not written\n", *a.slurm);
    const std::vector<Frames> tasks = sequence::split_frames(missing, a.tasks);
    std::error_code error;
    const std::string program = fs::read_symlink("/proc/self/exe", error).string();
    write_text_file(*a.slurm, sequence::slurm_script(error ? "pellucid" : program, a.given, tasks));
    a.image.console.print("{}: {} frames in {} tasks\n", *a.slurm, missing.size(), tasks.size());
}

/// Whether all frames are there, and can be read.
void gather(const SequenceArguments& a, const Frames& frames, const Plan& plan) {
    const auto [width, height] = parse_size(a.image.size);
    Outcome outcome;
    ProgressBar bar(a.image.console, "gather");
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const fs::path file = plan.files.file(frames[i]);
        try {
            const Image image = read_image(file);
            if (image.width != int(width) || image.height != int(height))
                throw Error(fmt::format("{}: has {} x {} pixels", file.string(), image.width, image.height));
        } catch (const Error& cause) {
            outcome.failures[frames[i]] = cause.what();
        }
        bar.show(double(i + 1) / double(frames.size()));
    }
    bar.clear();
    report_frames(a, frames.size(), outcome);
}

void remove_leftovers(const Frames& frames, const FilePattern& pattern) {
    std::vector<fs::path> files;
    for (const long frame : frames) files.push_back(pattern.file(frame));
    sequence::remove_leftovers(files.front().parent_path(), files);
}

void run_sequence(const SequenceArguments& a) {
    if (!(a.fps > 0.0)) throw Error(fmt::format("--fps: {} is not above 0", a.fps));
    if (a.tasks < 1) throw Error("--tasks: is at least 1");
    const Plan plan(a);
    check_technique_name(a.image.technique);
    const SceneOfFrames scenes(a, plan);
    const Frames frames = wanted_frames(a, plan, scenes.rest());
    check_outputs({plan.files.file(frames.front()).string()}, {a.image.scene, a.image.environment.name_or_file});
    // What no frame could be rendered with is said before any is.
    const Scene first = scenes.at(frames.front());
    for (const long frame : {frames.front(), frames.back()})
        if (plan.camera) parse_camera(plan.camera->at(frame), first, Camera{}.vertical_fov);
    if (a.gather) return gather(a, frames, plan);
    const Frames missing = missing_of(frames, plan.files);
    if (a.slurm) return write_slurm_script(a, missing);
    check_settings(a, plan);
    a.image.console.warn(scenes.rest().warnings);
    Outcome outcome;
    if (!missing.empty()) outcome = render_missing(missing, a, plan, scenes);
    remove_leftovers(frames, plan.files);
    for (const auto& [name, files] : plan.aovs) remove_leftovers(frames, files);
    report_frames(a, frames.size(), outcome);
}

/// Options as typed, but for those that decide only which frames are rendered, by whom, and what is reported.
std::vector<std::string> options_of_frames(const CLI::App& command) {
    const std::set<std::string> left_out{"frames", "gather", "slurm", "tasks", "device", "threads", "quiet", "verbose"};
    std::vector<std::string> given;
    for (const CLI::Option* option : command.get_options()) {
        const std::string name = option->get_positional() ? "" : option->get_lnames().front();
        if (option->count() == 0 || left_out.contains(name)) continue;
        const bool flag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->reduced_results()) {
            if (!name.empty()) given.push_back("--" + name);
            if (!flag) given.push_back(value);
        }
    }
    return given;
}

}  // namespace

void add_sequence_command(CLI::App& app) {
    auto arguments = std::make_shared<SequenceArguments>();
    SequenceArguments& a = *arguments;
    CLI::App* command =
        app.add_subcommand("sequence", "Render frames of an animation, a camera path or a moving light");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scene", a.image.scene, kSceneHelp)->required()->type_name("SCENE");
    command->option_defaults()->group("Frames");
    command
        ->add_option("-o,--output", a.image.output,
                     "Image of a frame, .png or .exr; # are its number. Frames that are there stay")
        ->required()
        ->type_name("FILE");
    command->add_option("--frames", a.frames, "Numbers of the frames, several with commas (default: all, from 0)")
        ->type_name("A..B");
    add_number(*command, "--fps", a.fps, "Frames per second of animation time")->capture_default_str();
    command->add_option("--camera-at", a.camera_keys, "orbit:... at a frame; the camera moves between (help sequences)")
        ->type_name("FRAME=CAMERA")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->add_option("--light-at", a.light_keys, "A further light, as of --add-light, at a frame; it moves between")
        ->type_name("FRAME=LIGHT")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->add_option("--aov", a.image.aovs, "Also write this quantity per pixel; may be repeated (help aovs)")
        ->type_name("NAME=FILE.exr")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command->option_defaults()->group("Cluster");
    CLI::Option* const slurm =
        command->add_option("--slurm", a.slurm, "Write a batch script for missing frames instead of rendering")
            ->type_name("FILE");
    add_number(*command, "--tasks", a.tasks, "Most tasks of the script's array job")
        ->capture_default_str()
        ->needs(slurm);
    command->add_flag("--gather", a.gather, "Render nothing; check that all frames are there and can be read")
        ->excludes(slurm);
    add_image_options(*command, a.image);
    command->get_option("--camera-at")->excludes("--camera");
    set_examples(*command,
                 {"pellucid sequence shape:gem -o ##.png --camera-at 0=orbit:0,15,4 --camera-at 60=orbit:360,15,4",
                  "pellucid sequence character.glb -o jump-####.png --animation jump --frames 0..47",
                  "pellucid sequence character.glb -o jump-####.png --slurm job.sh && sbatch job.sh"});
    command->callback([arguments, command] {
        arguments->given = options_of_frames(*command);
        run_sequence(*arguments);
    });
}

}  // namespace pellucid::cli
