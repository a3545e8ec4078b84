#include "commands.h"
#include "options/help.h"
#include "options/options.h"
#include "options/progress_bar.h"

#include <pellucid/error.h>
#include <pellucid/file.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace pellucid::cli {
namespace {

struct CommandArguments {
    std::string source;
    std::string output;
    std::optional<double> smoothing;  // no voxels given: of voxelize(), 0 for what is a volume already
    VoxelSettings voxels;
    DeviceArguments device;
    bool double_precision = false;
    bool uncompressed = false;
    SceneArguments how;
    Console console;
};

std::string range_of(const std::vector<float>& field) {
    const auto [low, high] = std::minmax_element(field.begin(), field.end());
    return fmt::format("{:.6g} to {:.6g}", *low, *high);
}

std::string range_of(const std::vector<glm::vec3>& field) {
    glm::vec3 low = field.front(), high = low;
    for (const glm::vec3& value : field) low = glm::min(low, value), high = glm::max(high, value);
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", low.r, low.g, low.b, high.r, high.g,
                       high.b);
}

void print_volume(const Console& console, const Volume& volume) {
    const glm::vec3 low = volume.low, high = volume.high();
    console.print("{}: {} x {} x {} voxels of {:.6g} m\n", one_line(volume.name), volume.size.x, volume.size.y,
                  volume.size.z, volume.voxel);
    console.print("box: {:.6g} {:.6g} {:.6g} to {:.6g} {:.6g} {:.6g} m\n", low.x, low.y, low.z, high.x, high.y, high.z);
    const auto print_field = [&console](const char* name, const auto& field) {
        if (!field.empty()) console.print("{}: {}\n", name, range_of(field));
    };
    print_field("n", volume.n);
    print_field("n_red", volume.n_red);
    print_field("n_blue", volume.n_blue);
    print_field("sigma_a", volume.sigma_a);
    print_field("sigma_s", volume.sigma_s);
    print_field("g", volume.g);
    print_field("emission", volume.emission);
    print_field("boundary", volume.boundary);
}

/// The scene's volume, smoothed further, or its solids of glass as voxels.
VoxelizedScene make_volume_of(const Scene& scene, const CommandArguments& arguments) {
    VoxelizedScene made;
    if (scene.objects.empty() && scene.volumes.size() == 1) {
        made.volume = *scene.volumes.front();
        smooth_index(made.volume, float(arguments.smoothing.value_or(0.0)));
    } else if (!scene.volumes.empty()) {
        throw Error(
            fmt::format("{}: has volumes already; one alone, or glass alone, becomes a file", one_line(scene.source)));
    } else {
        VoxelSettings settings = arguments.voxels;
        settings.closed_only = true;
        if (arguments.smoothing) settings.smoothing = float(*arguments.smoothing);
        made = voxelize(scene, settings, device_options(arguments.device));
    }
    made.warnings.insert(made.warnings.begin(), scene.warnings.begin(), scene.warnings.end());
    return made;
}

void make_volume_file(const CommandArguments& arguments) {
    if (lower_extension(arguments.output) != ".vdb")
        throw Error(fmt::format("--output: '{}': volumes are written as .vdb", arguments.output));
    check_outputs({arguments.output}, {arguments.source});
    const Scene scene = load_given_scene(arguments.source, arguments.how, arguments.console);
    ProgressBar bar(arguments.console, "voxels");
    VoxelizedScene made = make_volume_of(scene, arguments);
    bar.clear();
    // Back to the file's world. Rounding moves the volume as a whole, by half the spacing of floats there at most.
    made.volume.low = glm::dvec3(made.volume.low) + scene.origin;
    save_volume(arguments.output, made.volume,
                {.double_precision = arguments.double_precision, .compress = !arguments.uncompressed});
    print_volume(arguments.console, made.volume);
    arguments.console.warn(made.warnings);
}

}  // namespace

void add_volume_command(CLI::App& app) {
    auto arguments = std::make_shared<CommandArguments>();
    CommandArguments& a = *arguments;
    CLI::App* command = app.add_subcommand(
        "volume", "Make a volume of varying index, or of a scene's glass, and write it as an OpenVDB file");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command
        ->add_option("source", a.source,
                     "A scene whose glass becomes a volume, a .vdb file or volume:NAME (help volumes)")
        ->required()
        ->type_name("SOURCE");
    command->option_defaults()->group("Output");
    command->add_option("-o,--output", a.output, "OpenVDB file, compressed by Blosc")->required()->type_name("FILE");
    command->add_flag("--double", a.double_precision, "Grids of double precision");
    command->add_flag("--uncompressed", a.uncompressed, "Without compression");
    command->option_defaults()->group("Voxels");
    add_number(*command, "--smoothing", a.smoothing,
               "Gaussian that smooths the index, voxels, 0 to 16 (default 0.75 of glass, 0 of volumes)");
    const auto add_voxel_number = [&](const std::string& flag, auto& number, const std::string& help) {
        add_number(*command, flag, number, help)->capture_default_str();
    };
    add_voxel_number("--resolution", a.voxels.resolution, "Voxels along the longest side of the box, 8 to 65536");
    add_voxel_number("--coverage-samples", a.voxels.samples, "Columns through a voxel per axis, 1 to 16");
    add_voxel_number("--scattering", a.voxels.scattering, "Scattering inside the glass, 1/m");
    add_voxel_number("--mean-cosine", a.voxels.g, "Of that scattering, -1 to 1");
    add_voxel_number("--noise", a.voxels.noise,
                     "Share of absorption and scattering that noise takes away or adds, 0 to 1");
    add_voxel_number("--noise-scale", a.voxels.noise_scale, "Width of that noise, m; 0: a quarter of the box");
    add_scene_options(*command, a.how);
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    set_examples(*command, {"pellucid volume volume:smoke -o smoke.vdb",
                            "pellucid volume shape:gem -o gem.vdb --resolution 256"});
    command->callback([arguments] { make_volume_file(*arguments); });
}

}  // namespace pellucid::cli
