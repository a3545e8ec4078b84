#include "lab/compare_options.h"

#include "lab/image_truth.h"
#include "options/help.h"
#include "options/named_technique.h"

#include <fmt/format.h>

namespace pellucid::cli {

void add_compare_options(CLI::App& command, CompareArguments& a) {
    command.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command.add_option("scenes", a.scenes, kSceneHelp)
        ->required()
        ->type_name("SCENE...")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command.option_defaults()->group("Output");
    command.add_option("--json", a.json, "Write every measure of every run")->type_name("FILE");
    command.add_option("--html", a.html, "Write a report that opens in a browser from disk")->type_name("DIR");
    command.option_defaults()->group("Comparison");
    add_techniques_option(command, a.techniques);
    add_size_option(command, a.size);
    add_number(command, "--views", a.views, "Cameras around the object, 15 degrees above it, the first from the front")
        ->capture_default_str();
    add_number(command, "--samples", a.samples, "Jittered frames per image; paths are compared at pixel centres")
        ->capture_default_str();
    add_number(command, "--exact-events", a.exact_events, "Interface events that exact paths may have")
        ->capture_default_str()
        ->check(CLI::Range(1, 4095))
        ->type_name("N");
    command
        .add_option("--truth", a.truth,
                    "Whose image FLIP and RMSE are taken against: path (all light) or reference (the exact transmitted "
                    "path, shaded as the others are)")
        ->capture_default_str()
        ->type_name("NAME");
    add_number(command, "--truth-samples", a.truth_samples,
               fmt::format("Paths per pixel of --truth path; default: {} to {}, as the differences between "
                           "techniques need",
                           kTruthSamples, kMostTruthSamples))
        ->type_name("N");
    add_display_options(command, a.tonemap, a.exposure_ev);
    add_environment_options(command, a.environment);
    add_light_options(command, a.light);
    add_scene_options(command, a.how);
    command.option_defaults()->group("Thickness");
    command.add_flag("--thickness", a.thickness, "Compare the methods of 'help translucency' instead, for every light");
    add_light_map_options(command, a.thickness_how);
    command.add_option("--pictures", a.pictures, "With --thickness: images of thickness and error, .png")
        ->type_name("DIR");
    add_device_options(command, a.device);
    add_console_options(command, a.console);
    add_parameter_options(command, a.parameters);
    set_examples(command, {"pellucid compare bunny.obj shape:torus --techniques one-interface,wang-2014 --html report",
                           "pellucid compare shape:goblet --views 1 --size 256x256 --json goblet.json"});
}

}  // namespace pellucid::cli
