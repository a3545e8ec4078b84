#include "commands.h"
#include "options/help.h"
#include "options/options.h"

#include <pellucid/pellucid.h>

#include <memory>
#include <string>

namespace pellucid::cli {
namespace {

struct ExportArguments {
    std::string scene;
    std::string output;
    SceneArguments how;
    Console console;
};

void export_scene(const ExportArguments& arguments) {
    check_outputs({arguments.output}, {arguments.scene});
    const Scene scene = load_given_scene(arguments.scene, arguments.how, arguments.console);
    arguments.console.warn(scene.warnings);
    arguments.console.warn(write_scene(arguments.output, scene));
}

}  // namespace

void add_export_command(CLI::App& app) {
    auto arguments = std::make_shared<ExportArguments>();
    ExportArguments& a = *arguments;
    CLI::App* command = app.add_subcommand("export", "Write a scene, as it is loaded and posed, for other programs");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("scene", a.scene, kSceneHelp)->required()->type_name("SCENE");
    command->option_defaults()->group("Output");
    command->add_option("-o,--output", a.output, "Binary glTF (.glb), or Wavefront OBJ with a .mtl file beside (.obj)")
        ->required()
        ->type_name("FILE");
    add_scene_options(*command, a.how);
    add_console_options(*command, a.console);
    set_examples(*command, {"pellucid export shape:goblet -o goblet.glb",
                            "pellucid export character.glb -o jump.glb --animation jump --time 0.4"});
    command->callback([arguments] { export_scene(*arguments); });
}

}  // namespace pellucid::cli
