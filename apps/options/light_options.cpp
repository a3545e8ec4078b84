#include "options/light_options.h"

#include "options/options.h"

namespace pellucid::cli {

void add_light_options(CLI::App& command, LightArguments& arguments) {
    command
        .add_option(
            "--light", arguments.transport,
            "Light that frames follow to opaque surfaces. environment: of the environment alone, unshadowed; direct: "
            "of lights, too, with shadows; full: also reflected between surfaces, with what hides the environment; "
            "automatic: environment where there are no lights, full with 8 samples or more, direct with fewer")
        ->capture_default_str()
        ->type_name("NAME");
    command
        .add_option("--shadows", arguments.shadows,
                    "Of glass. exact: it blocks the straight ray to a light; tinted: it weakens it")
        ->capture_default_str()
        ->type_name("NAME");
    command
        .add_option(
            "--caustics", arguments.caustics,
            "Technique that finds where the light of --photons leaves glass, run from the lights' views; default: "
            "photons follow every interface")
        ->type_name("NAME");
    add_number(command, "--bounces", arguments.bounces,
               "Reflections that rays follow, 0 to 7, before a cache has the rest; --light full")
        ->capture_default_str();
}

LightOptions light_options(const LightArguments& arguments) {
    return {parse_light_transport(arguments.transport), parse_shadows(arguments.shadows), arguments.caustics,
            arguments.bounces};
}

}  // namespace pellucid::cli
