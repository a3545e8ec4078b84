#include "options/volume_options.h"

#include "options/arguments.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace pellucid::cli {
namespace {

/// GRID=FIELD[:SCALE]; files may have grids without a name.
GridMapping parse_grid_mapping(const std::string& text) {
    constexpr auto kNone = std::string::npos;
    const std::size_t equals = text.find('='), colon = equals == kNone ? kNone : text.find(':', equals);
    if (equals == kNone || equals + 1 == text.size())
        throw Error(fmt::format("--map: '{}' should be GRID=FIELD[:SCALE]", text));
    GridMapping mapping;
    mapping.grid = text.substr(0, equals);
    mapping.field = text.substr(equals + 1, colon == kNone ? kNone : colon - equals - 1);
    if (mapping.field == "level-set") mapping.scale = Material{}.ior;
    if (colon != kNone) mapping.scale = float(parse_number("--map", text.substr(colon + 1)));
    return mapping;
}

std::vector<GridMapping> parse_grid_mappings(const VolumeArguments& arguments) {
    std::vector<GridMapping> mappings;
    for (const std::string& text : arguments.grids) mappings.push_back(parse_grid_mapping(text));
    return mappings;
}

bool is_vdb(const std::string& source) { return lower_extension(source) == ".vdb"; }

/// SOURCE[@X,Y,Z[,SCALE]]
struct PlacedVolume {
    std::string source;
    glm::dvec3 position{0.0};  ///< in the file's world, m
    float scale = 1.0f;
};

PlacedVolume parse_placed_volume(const std::string& text) {
    PlacedVolume placed{.source = text};
    const std::size_t at = text.rfind('@');
    if (at == std::string::npos) return placed;
    placed.source = text.substr(0, at);
    const std::string numbers = text.substr(at + 1);
    const auto count = std::size_t(std::count(numbers.begin(), numbers.end(), ',')) + 1;
    const std::vector<double> v = parse_numbers("--add-volume", numbers, std::clamp<std::size_t>(count, 3, 4));
    placed.position = {v[0], v[1], v[2]};
    if (v.size() > 3) placed.scale = float(v[3]);
    if (!(placed.scale > 0.0f)) throw Error(fmt::format("--add-volume: '{}': the scale must be above 0", text));
    return placed;
}

}  // namespace

void add_volume_options(CLI::App& command, VolumeArguments& arguments) {
    command
        .add_option("--add-volume", arguments.added,
                    "Add a .vdb file or volume:NAME, scaled, then moved; may be repeated (help volumes)")
        ->type_name("VOLUME[@X,Y,Z[,SCALE]]")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    command
        .add_option("--map", arguments.grids, "Which field a grid of a .vdb file is; may be repeated (help volumes)")
        ->type_name("GRID=FIELD")
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

LoadOptions with_grids(LoadOptions options, const std::string& source, const VolumeArguments& arguments) {
    const bool for_others = std::any_of(arguments.added.begin(), arguments.added.end(), [](const std::string& text) {
        return is_vdb(parse_placed_volume(text).source);
    });
    // Where no file has grids, loading the scene says that there are none to map.
    if (is_vdb(source) || !for_others) options.grids = parse_grid_mappings(arguments);
    return options;
}

void add_volumes(Scene& scene, const VolumeArguments& arguments) {
    for (const std::string& text : arguments.added) {
        const PlacedVolume placed = parse_placed_volume(text);
        LoadOptions options;
        if (is_vdb(placed.source)) options.grids = parse_grid_mappings(arguments);
        Scene added = load_scene(placed.source, options);
        if (added.volumes.size() != 1 || !added.objects.empty())
            throw Error(fmt::format("--add-volume: '{}' is neither a .vdb file nor volume:NAME", text));
        VolumeObject object = std::move(added.volume_objects.front());
        object.volume = int(scene.volumes.size());
        object.world_from_volume = glm::mat4(placed.scale);
        const glm::dvec3 origin = placed.position + double(placed.scale) * added.origin;
        object.world_from_volume[3] = glm::vec4(origin - scene.origin, 1.0);
        scene.volumes.push_back(std::move(added.volumes.front()));
        scene.volume_objects.push_back(std::move(object));
    }
}

}  // namespace pellucid::cli
