#include "lab/commands.h"
#include "options/help.h"
#include "options/options.h"

#include <pellucid/file.h>
#include <pellucid/pellucid.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <optional>

namespace pellucid::cli {
namespace {

struct DifferenceArguments {
    std::string reference, test;
    std::optional<std::string> mask, map, json;
    std::optional<double> exposure_ev;
};

bool is_linear(const std::string& file) {
    const std::string extension = lower_extension(file);
    return extension == ".exr" || extension == ".hdr";
}

/// The first three channels of a picture file: R, G, B.
Image read_rgb(const std::string& file) {
    const Image image = read_image(file);
    if (image.channels == 3) return image;
    if (image.channels < 3) throw Error(fmt::format("{}: a picture has 3 channels, not {}", file, image.channels));
    Image rgb(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) std::copy_n(image.at(x, y), 3, rgb.at(x, y));
    }
    return rgb;
}

/// 1 where the first channel of a file is above 0; all ones without a file.
std::vector<std::uint8_t> read_mask(const std::optional<std::string>& file, const Image& picture) {
    if (!file) return std::vector<std::uint8_t>(std::size_t(picture.width) * std::size_t(picture.height), 1);
    const Image image = read_image(*file);
    if (image.width != picture.width || image.height != picture.height)
        throw Error(fmt::format("{}: {}x{} pixels, but the pictures have {}x{}", *file, image.width, image.height,
                                picture.width, picture.height));
    std::vector<std::uint8_t> mask;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) mask.push_back(*image.at(x, y) > 0.0f);
    }
    return mask;
}

Image flip_of(const DifferenceArguments& arguments, const Image& reference, const Image& test) {
    if (!is_linear(arguments.reference)) return flip_ldr(reference, test);
    FlipExposures exposures = flip_exposures(reference);
    if (arguments.exposure_ev) exposures = {*arguments.exposure_ev, *arguments.exposure_ev, 1};
    return flip_hdr(reference, test, exposures);
}

void show_difference(const DifferenceArguments& arguments) {
    std::vector<std::string> outputs, inputs{arguments.reference, arguments.test};
    if (arguments.map) outputs.push_back(*arguments.map);
    if (arguments.json) outputs.push_back(*arguments.json);
    if (arguments.mask) inputs.push_back(*arguments.mask);
    check_outputs(outputs, inputs);
    if (is_linear(arguments.reference) != is_linear(arguments.test))
        throw Error("one picture is linear (.exr, .hdr), and the other is encoded for a display");
    if (arguments.exposure_ev && !is_linear(arguments.reference))
        throw Error("--exposure: of linear pictures only (.exr, .hdr)");
    const Image reference = read_rgb(arguments.reference), test = read_rgb(arguments.test);
    const Image flip = flip_of(arguments, reference, test);
    const std::vector<std::uint8_t> mask = read_mask(arguments.mask, reference);
    const auto pixels = std::count(mask.begin(), mask.end(), 1);
    if (pixels == 0) throw Error(fmt::format("{}: no pixel is above 0", *arguments.mask));
    const double flip_mean = mean(flip, mask), error = rmse(reference, test, mask);
    if (arguments.map) write_image(*arguments.map, flip);
    if (arguments.json)
        write_json(*arguments.json, {{"reference", arguments.reference},
                                     {"test", arguments.test},
                                     {"pixels", pixels},
                                     {"flip_mean", flip_mean},
                                     {"rmse", error}});
    fmt::print("FLIP {:.6f}  RMSE {:.6g}  over {} pixels\n", flip_mean, error, pixels);
}

}  // namespace

void add_difference_command(CLI::App& app) {
    auto arguments = std::make_shared<DifferenceArguments>();
    DifferenceArguments& a = *arguments;
    CLI::App* command =
        app.add_subcommand("difference", "Measure how far a picture is from another, of whatever renderer");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command
        ->add_option("reference", a.reference,
                     "The true picture: linear (.exr, .hdr), or encoded for a display (.png, ...)")
        ->required()
        ->type_name("FILE");
    command->add_option("test", a.test, "The picture that is measured, of the same size and kind")
        ->required()
        ->type_name("FILE");
    command
        ->add_option("--mask", a.mask, "Counts only the pixels above 0 in the first channel, as of --aov events=FILE")
        ->type_name("FILE");
    add_number(
        *command, "--exposure", a.exposure_ev,
        "FLIP of linear pictures at one exposure; default: the worst of those that suit the reference (HDR-FLIP)")
        ->type_name("EV");
    command->add_option("--flip-map,--map", a.map, "Write FLIP per pixel, 0 to 1, .exr or .png")->type_name("FILE");
    command->add_option("--json", a.json, "Write the numbers")->type_name("FILE");
    set_examples(*command, {"pellucid difference truth.exr test.exr --flip-map flip.png",
                            "pellucid difference truth.png test.png --mask events.exr --json difference.json"});
    command->callback([arguments] { show_difference(*arguments); });
}

}  // namespace pellucid::cli
