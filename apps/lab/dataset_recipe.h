#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace pellucid::cli {

/// A number is drawn uniformly from low..high.
struct Range {
    double low = 0.0, high = 0.0;
};

/// What the images of a data set are drawn from.
struct Recipe {
    std::filesystem::path folder;  ///< files of the recipe are relative to it
    double width = 256, height = 256, images = 100, seed = 1;
    std::vector<std::string> sources{"shape:goblet", "shape:sphere", "shape:torus", "shape:knot", "shape:gem"};
    Range count{1, 3}, size_m{0.08, 0.2}, ior{1.33, 1.6}, tint{0.3, 1.0}, attenuation_distance_m{0.05, 0.5};
    double clear_share = 0.5, spread_m = 0.12;
    std::vector<std::string> backgrounds{"noise", "checker", "stripes"};
    Range background_distance_m{0.2, 1.0};
    Range distance_m{0.5, 0.8}, elevation_deg{-10, 50}, fov_deg{30, 45};
    std::vector<std::string> environments{"studio", "sky"};
    Range environment_intensity{0.7, 1.3};
    std::string technique = "visibility-layers";
    double samples = 4, max_events = 16;
};

/// One value of a recipe's file. The table of them is the file's schema.
struct RecipeField {
    const char* name;  ///< "GROUP.KEY", or "KEY"
    std::variant<double*, Range*, std::string*, std::vector<std::string>*> target;
    double minimum, maximum;
    bool whole;
    const char* doc;
};
std::vector<RecipeField> fields_of(Recipe& recipe);

/// Reads a recipe; what the file does not have keeps its default. Throws Error naming the file and the key.
Recipe read_recipe(const std::filesystem::path& file);

/// JSON Schema of recipes, with their defaults.
nlohmann::ordered_json recipe_schema();

}  // namespace pellucid::cli
