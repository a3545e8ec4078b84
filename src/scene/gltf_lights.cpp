#include "scene/gltf_lights.h"

#include "core/fail.h"
#include "core/math.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>

namespace pellucid {
namespace {

constexpr const char* kExtension = "KHR_lights_punctual";
constexpr double kBrightest = 1e12, kFarthest = 1e15;

/// Index of a node's light; empty if it has none.
std::optional<int> light_of(const GltfFile& gltf, const tinygltf::Node& node, const std::string& node_name) {
    const auto extension = node.extensions.find(kExtension);
    if (extension == node.extensions.end()) return std::nullopt;
    const tinygltf::Value& properties = extension->second;
    if (!properties.IsObject() || !properties.Has("light") || !properties.Get("light").IsInt())
        fail(gltf.path, fmt::format("{}: {} does not say which light", node_name, kExtension));
    return properties.Get("light").GetNumberAsInt();
}

class LightReader {
public:
    LightReader(const tinygltf::Light& from, Light& light, Warnings& warnings)
        : from_(from), light_(light), warnings_(warnings) {}

    /// Reads everything but the placement. Returns false, with a warning, for a light of unknown type.
    bool read() {
        if (from_.type == "directional") {
            light_.kind = Light::Kind::kDirectional;
        } else if (from_.type == "point") {
            light_.kind = Light::Kind::kPoint;
        } else if (from_.type == "spot") {
            light_.kind = Light::Kind::kSpot;
        } else {
            warnings_.add(fmt::format("light {}: left out, its type '{}' is not known", light_.name, from_.type));
            return false;
        }
        const double intensity = in_range(from_.intensity, 0.0, kBrightest, "intensity");
        for (int k = 0; k < 3; ++k) {
            const double color = from_.color.size() == 3 ? from_.color[std::size_t(k)] : 1.0;
            light_.intensity[k] = static_cast<float>(intensity * in_range(color, 0.0, 1.0, "color"));
        }
        if (light_.kind != Light::Kind::kDirectional) read_range();
        read_size();
        if (light_.kind == Light::Kind::kSpot) read_cone();
        return true;
    }

private:
    double in_range(double value, double low, double high, const char* what) {
        if (value >= low && value <= high) return value;
        const double used = value > high ? high : low;
        warnings_.add(fmt::format("light {}: {} {} is out of range, {} used", light_.name, what, value, used));
        return used;
    }

    /// Reads the range. tinygltf returns 0 for a missing range, which is infinite.
    void read_range() {
        if (from_.range > 0.0) {
            light_.range = static_cast<float>(in_range(from_.range, 1e-15, kFarthest, "range"));
        } else if (from_.range < 0.0) {
            warnings_.add(fmt::format("light {}: range {} is out of range, none used", light_.name, from_.range));
        }
    }

    /// Reads the size from `extras.radius`, m, or `extras.angular_diameter`, radians, because the extension has no
    /// sizes.
    void read_size() {
        constexpr double kWidest = 3.14;
        const bool sun = light_.kind == Light::Kind::kDirectional;
        const char* name = sun ? "angular_diameter" : "radius";
        if (!from_.extras.IsObject() || !from_.extras.Has(name) || !from_.extras.Get(name).IsNumber()) return;
        const double size = in_range(from_.extras.Get(name).GetNumberAsDouble(), 0.0, sun ? kWidest : kFarthest, name);
        (sun ? light_.angular_diameter : light_.radius) = static_cast<float>(size);
    }

    void read_cone() {
        constexpr double kNarrowest = 1e-4, kRightAngle = std::numbers::pi / 2.0;
        const double outer = in_range(from_.spot.outerConeAngle, kNarrowest, kRightAngle, "outerConeAngle");
        light_.outer_cone_angle = static_cast<float>(outer);
        light_.inner_cone_angle = static_cast<float>(in_range(from_.spot.innerConeAngle, 0.0, outer, "innerConeAngle"));
        // A cone without falloff gets the narrowest representable one.
        if (light_.inner_cone_angle >= light_.outer_cone_angle)
            light_.inner_cone_angle = std::nextafter(light_.outer_cone_angle, 0.0f);
    }

    const tinygltf::Light& from_;
    Light& light_;
    Warnings& warnings_;
};

}  // namespace

void add_gltf_light(const GltfFile& gltf, const tinygltf::Node& node, const std::string& node_name,
                    const glm::dmat4& world_from_node, Scene& scene, Warnings& warnings) {
    const std::optional<int> number = light_of(gltf, node, node_name);
    if (!number) return;
    if (*number < 0 || std::size_t(*number) >= gltf.model.lights.size())
        fail(gltf.path, fmt::format("{}: there is no light {}", node_name, *number));
    const tinygltf::Light& from = gltf.model.lights[std::size_t(*number)];
    Light light;
    light.name = from.name.empty() ? node_name : from.name;
    if (!LightReader(from, light, warnings).read()) return;
    light.position = glm::vec3(world_from_node[3]);
    const glm::dvec3 along = -glm::dvec3(world_from_node[2]);
    const double length = glm::length(along);
    if (light.kind != Light::Kind::kPoint && !(length > 0.0 && std::isfinite(length))) {
        warnings.add(fmt::format("light {}: left out, it points nowhere", light.name));
        return;
    }
    if (light.kind != Light::Kind::kPoint) light.direction = glm::vec3(along / length);
    scene.lights.push_back(std::move(light));
}

}  // namespace pellucid
