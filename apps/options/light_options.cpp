#include "options/light_options.h"

#include "options/options.h"

namespace pellucid::cli {

void add_light_options(CLI::App& command, LightArguments& arguments) {
    command.option_defaults()->group("Light");
    command
        .add_option("--light", arguments.transport,
                    "Light on opaque surfaces: environment, direct, full or automatic (help lights)")
        ->capture_default_str()
        ->type_name("NAME");
    command
        .add_option("--shadows", arguments.shadows,
                    "Of glass: exact blocks a straight ray to a light, tinted weakens it")
        ->capture_default_str()
        ->type_name("NAME");
    command
        .add_option("--caustics", arguments.caustics, "Technique that finds where the light of --photons leaves glass")
        ->type_name("TECHNIQUE");
    add_number(command, "--bounces", arguments.bounces, "Reflections followed before a cache has the rest, 0 to 7")
        ->capture_default_str();
}

LightOptions light_options(const LightArguments& arguments) {
    return {parse_light_transport(arguments.transport), parse_shadows(arguments.shadows), arguments.caustics,
            arguments.bounces};
}

}  // namespace pellucid::cli
