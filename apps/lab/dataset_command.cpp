#include "lab/commands.h"
#include "lab/dataset_sample.h"
#include "options/help.h"
#include "options/options.h"
#include "options/progress_bar.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;

struct DatasetArguments {
    std::string recipe;
    std::optional<std::string> folder, images;
    bool gather = false, schema = false, allow_outside = false;
    DeviceArguments device;
    Console console;
};

struct Images {
    std::uint64_t first = 0, last = 0;
};

/// "A..B", both included, within the recipe's images.
Images parse_images(const std::string& text, std::uint64_t count) {
    const std::size_t dots = text.find("..");
    const auto whole = [&](const std::string& number) {
        const double value = parse_number("--images", number);
        if (value < 0 || value != std::floor(value) || value >= double(count))
            throw Error(fmt::format("--images {}: the recipe has images 0 to {}", text, count - 1));
        return std::uint64_t(value);
    };
    if (dots == std::string::npos) return {whole(text), whole(text)};
    const Images images{whole(text.substr(0, dots)), whole(text.substr(dots + 2))};
    if (images.first > images.last) throw Error(fmt::format("--images {}: the first comes after the last", text));
    return images;
}

/// Whatever images the folder has, in order.
std::vector<nlohmann::ordered_json> read_descriptions(const fs::path& folder, const Images& images) {
    std::vector<nlohmann::ordered_json> descriptions;
    for (std::uint64_t i = images.first; i <= images.last; ++i) {
        const fs::path file = folder / (sample_name(i) + ".json");
        std::ifstream stream(file);
        if (!stream) continue;
        try {
            descriptions.push_back(nlohmann::ordered_json::parse(stream));
        } catch (const nlohmann::json::exception& error) {
            throw Error(fmt::format("{}: {}; make this image again", file.string(), error.what()));
        }
    }
    return descriptions;
}

void write_annotations(const fs::path& folder, const Images& images, std::uint64_t count, const Console& console) {
    const bool all = images.first == 0 && images.last == count - 1;
    const std::string name =
        all ? "annotations.json" : fmt::format("annotations.{}-{}.json", images.first, images.last);
    const std::vector<nlohmann::ordered_json> descriptions = read_descriptions(folder, images);
    write_text_file(folder / name, coco_annotations(descriptions).dump() + "\n");
    console.print("{} images in {}\n", descriptions.size(), (folder / name).string());
    const std::uint64_t wanted = images.last - images.first + 1;
    if (descriptions.size() < wanted)
        console.warn({fmt::format("{} of {} images are missing", wanted - descriptions.size(), wanted)});
}

void make_images(const Recipe& recipe, const fs::path& folder, const Images& images,
                 const DatasetArguments& arguments) {
    check_technique_name(recipe.technique);
    const DatasetScenes scenes(recipe, arguments.allow_outside);
    Renderer renderer(device_options(arguments.device));
    std::vector<std::string> warnings = scenes.warnings();
    std::uint64_t with_warnings = 0;
    ProgressBar bar(arguments.console, fmt::format("images {} to {}", images.first, images.last));
    for (std::uint64_t i = images.first; i <= images.last; ++i) {
        const DatasetScene made = scenes.make(i);
        const DatasetSample sample = make_sample(recipe, made, renderer, arguments.device.threads);
        write_sample(folder, i, recipe, made, sample);
        with_warnings += sample.with_glass.warnings.empty() ? 0 : 1;
        bar.show(double(i - images.first + 1) / double(images.last - images.first + 1));
    }
    bar.clear();
    if (with_warnings > 0)
        warnings.push_back(fmt::format("{} images have warnings, which their .json files list", with_warnings));
    arguments.console.warn(warnings);
    check_validation(renderer);
}

void run(const DatasetArguments& arguments) {
    if (arguments.schema) {
        fmt::print("{}\n", recipe_schema().dump(2));
        return;
    }
    if (!arguments.folder) throw Error("--folder is required (see 'pellucid dataset --help')");
    const Recipe recipe = arguments.recipe.empty() ? Recipe{} : read_recipe(arguments.recipe);
    const auto count = std::uint64_t(recipe.images);
    const Images images = arguments.images ? parse_images(*arguments.images, count) : Images{0, count - 1};
    const fs::path folder = *arguments.folder;
    std::error_code error;
    fs::create_directories(folder, error);
    check_writable(folder / "annotations.json");
    if (!arguments.gather) make_images(recipe, folder, images, arguments);
    write_annotations(folder, images, count, arguments.console);
}

}  // namespace

void add_dataset_command(CLI::App& app) {
    auto arguments = std::make_shared<DatasetArguments>();
    DatasetArguments& a = *arguments;
    CLI::App* command = app.add_subcommand("dataset", "Make images of random glass with their masks, flow and poses");
    command->option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    command->add_option("recipe", a.recipe, "A JSON file (--schema describes it); default: the recipe of all defaults")
        ->type_name("RECIPE");
    command->option_defaults()->group("Output");
    command->add_option("--folder", a.folder, "Where the images are written; it is made if it is missing")
        ->type_name("DIR");
    command->add_option("--images", a.images, "Make these only, from 0; every image can be made alone")
        ->type_name("A..B");
    command->add_flag("--gather", a.gather, "Make no images; write annotations.json of those that are there");
    command->add_flag("--schema", a.schema, "Print the JSON Schema of recipes, with its defaults");
    command->add_flag("--allow-outside", a.allow_outside, kAllowOutsideHelp);
    add_device_options(*command, a.device);
    add_console_options(*command, a.console);
    set_examples(*command, {"pellucid dataset recipe.json --folder out/glass",
                            "pellucid dataset recipe.json --folder out/glass --images 500..999",
                            "pellucid dataset recipe.json --folder out/glass --gather"});
    command->callback([arguments] { run(*arguments); });
}

}  // namespace pellucid::cli
