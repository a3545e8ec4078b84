#include "lab/dataset_recipe.h"

#include <pellucid/error.h>
#include <pellucid/names.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace pellucid::cli {
namespace {

using Json = nlohmann::ordered_json;

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// Parses one value; `where` names the file and the key.
class ValueReader {
public:
    ValueReader(const RecipeField& field, const Json& json, std::string where)
        : field_(field), json_(json), where_(std::move(where)) {}

    void operator()(double* target) const { *target = number(json_); }
    void operator()(Range* target) const {
        const bool pair = json_.is_array() && json_.size() == 2;
        *target = pair ? Range{number(json_[0]), number(json_[1])} : Range{number(json_), number(json_)};
        if (target->low > target->high) throw Error(fmt::format("{}: the lower end is above the upper one", where_));
    }
    void operator()(std::string* target) const {
        if (!json_.is_string()) throw Error(fmt::format("{}: must be a name", where_));
        *target = json_.get<std::string>();
    }
    void operator()(std::vector<std::string>* target) const {
        const bool strings = json_.is_array() && !json_.empty() &&
                             std::all_of(json_.begin(), json_.end(), [](const Json& each) { return each.is_string(); });
        if (!strings) throw Error(fmt::format("{}: must be a list of names or files", where_));
        *target = json_.get<std::vector<std::string>>();
    }

private:
    double number(const Json& json) const {
        const double value = json.is_number() ? json.get<double>() : NAN;
        const bool good =
            value >= field_.minimum && value <= field_.maximum && (!field_.whole || value == std::floor(value));
        if (good) return value;
        throw Error(fmt::format("{}: must be {} from {} to {}{}", where_, field_.whole ? "a whole number" : "a number",
                                field_.minimum, field_.maximum,
                                std::holds_alternative<Range*>(field_.target) ? ", or [low, high] of them" : ""));
    }

    const RecipeField& field_;
    const Json& json_;
    std::string where_;
};

void read_value(const std::vector<RecipeField>& fields, const std::string& name, const Json& json,
                const std::string& file) {
    std::vector<std::string_view> known;
    for (const RecipeField& field : fields) {
        known.push_back(field.name);
        if (name != field.name) continue;
        std::visit(ValueReader(field, json, fmt::format("{}: {}", file, name)), field.target);
        return;
    }
    throw Error(fmt::format("{}: {}", file, unknown_name("key", name, known).what()));
}

Json number_schema(const RecipeField& field) {
    return {{"type", field.whole ? "integer" : "number"}, {"minimum", field.minimum}, {"maximum", field.maximum}};
}

Json field_schema(const RecipeField& field) {
    const Overloaded schema_of{
        [&](const double* value) {
            Json json = number_schema(field);
            json["default"] = *value;
            return json;
        },
        [&](const Range* value) {
            const Json pair{{"type", "array"}, {"items", number_schema(field)}, {"minItems", 2}, {"maxItems", 2}};
            return Json{{"anyOf", {number_schema(field), pair}}, {"default", {value->low, value->high}}};
        },
        [](const std::string* value) {
            return Json{{"type", "string"}, {"default", *value}};
        },
        [](const std::vector<std::string>* value) {
            return Json{{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}, {"default", *value}};
        }};
    Json json = std::visit(schema_of, field.target);
    json["description"] = field.doc;
    return json;
}

Json object_schema() { return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}}; }

}  // namespace

std::vector<RecipeField> fields_of(Recipe& r) {
    constexpr double kMany = 1e9, kLong = 1e4;
    return {
        {"width", &r.width, 8, 8192, true, "pixels"},
        {"height", &r.height, 8, 8192, true, "pixels"},
        {"images", &r.images, 1, kMany, true, "number of images"},
        {"seed", &r.seed, 0, kMany, true, "images of other seeds are others"},
        {"objects.sources", &r.sources, 0, 0, false, "files, or shape:NAME; each has refracting glass"},
        {"objects.count", &r.count, 1, 100, true, "objects of an image"},
        {"objects.size_m", &r.size_m, 1e-3, kLong, false, "largest side of an object's box, m"},
        {"objects.ior", &r.ior, 1, 4, false, "index of refraction of an object's glass"},
        {"objects.tint", &r.tint, 0.01, 1, false, "red, green and blue that coloured glass leaves of white light"},
        {"objects.attenuation_distance_m", &r.attenuation_distance_m, 1e-4, kLong, false,
         "metres of coloured glass after which the tint is left"},
        {"objects.clear_share", &r.clear_share, 0, 1, false, "share of objects without colour"},
        {"objects.spread_m", &r.spread_m, 0, kLong, false,
         "centres lie in a ball of this radius, which grows until objects do not touch, m"},
        {"background.images", &r.backgrounds, 0, 0, false, "noise, checker, stripes, or image files (sRGB)"},
        {"background.distance_m", &r.background_distance_m, 1e-3, kLong, false, "of the plane behind the objects, m"},
        {"camera.distance_m", &r.distance_m, 1e-2, kLong, false,
         "from the ball's centre, m; at least 1.2 times the way to the farthest surface"},
        {"camera.elevation_deg", &r.elevation_deg, -89, 89, false, "degrees above the horizon"},
        {"camera.fov_deg", &r.fov_deg, 1, 120, false, "vertical field of view, degrees"},
        {"environment.sources", &r.environments, 0, 0, false, "studio, checker, sky, uniform, or .hdr and .exr files"},
        {"environment.intensity", &r.environment_intensity, 0, 1e3, false, "factor of the radiance"},
        {"render.technique", &r.technique, 0, 0, false, "technique or preset that draws the colours"},
        {"render.samples", &r.samples, 1, 65536, true, "samples of each pixel's colour"},
        {"render.max_events", &r.max_events, 1, 65535, true, "interfaces that an exact path follows"},
    };
}

Recipe read_recipe(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::ifstream stream(file);
    if (!stream) throw Error(fmt::format("{}: no such file, or it cannot be read", name));
    Json json;
    try {
        json = Json::parse(stream);
    } catch (const nlohmann::json::exception& error) {
        throw Error(fmt::format("{}: {}", name, error.what()));
    }
    if (!json.is_object()) throw Error(fmt::format("{}: a recipe is a JSON object", name));
    Recipe recipe;
    recipe.folder = file.parent_path();
    const std::vector<RecipeField> fields = fields_of(recipe);
    for (const auto& [key, value] : json.items()) {
        if (key == "$schema") continue;
        if (!value.is_object()) {
            read_value(fields, key, value, name);
            continue;
        }
        for (const auto& [inner, inner_value] : value.items())
            read_value(fields, fmt::format("{}.{}", key, inner), inner_value, name);
    }
    return recipe;
}

nlohmann::ordered_json recipe_schema() {
    Recipe defaults;
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Recipe of pellucid dataset"}};
    schema.update(object_schema());
    for (const RecipeField& field : fields_of(defaults)) {
        const std::string name = field.name;
        const std::size_t dot = name.find('.');
        Json* properties = &schema["properties"];
        if (dot != std::string::npos) {
            Json& group = (*properties)[name.substr(0, dot)];
            if (group.is_null()) group = object_schema();
            properties = &group["properties"];
        }
        (*properties)[dot == std::string::npos ? name : name.substr(dot + 1)] = field_schema(field);
    }
    return schema;
}

}  // namespace pellucid::cli
