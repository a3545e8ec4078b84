#include "lab/dataset_scene.h"

#include "lab/dataset_patterns.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid::cli {
namespace {

/// Files are relative to the recipe; names with a colon are shapes.
std::string located(const Recipe& recipe, const std::string& source) {
    const bool name = source.find(':') != std::string::npos || std::filesystem::path(source).is_absolute();
    return name ? source : (recipe.folder / source).string();
}

Scene load_source(const Recipe& recipe, const std::string& source, bool allow_outside) {
    LoadOptions options;
    options.allow_outside = allow_outside;
    Scene scene = load_scene(located(recipe, source), options);
    const bool glass = std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
        return scene.materials[std::size_t(object.material)].refractive();
    });
    if (!glass || !scene.volume_objects.empty())
        throw Error(fmt::format("{}: objects of a data set are solids of refracting glass", source));
    return scene;
}

/// splitmix64 (Steele, Lea & Flood 2014): spreads neighbouring numbers.
std::uint64_t spread_bits(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

Material random_glass(const Recipe& recipe, DatasetRandom& random) {
    Material glass;
    glass.ior = float(random.within(recipe.ior));
    if (random.uniform() < recipe.clear_share) return glass;
    for (int c = 0; c < 3; ++c) glass.attenuation_color[c] = float(random.within(recipe.tint));
    glass.attenuation_distance = float(random.within(recipe.attenuation_distance_m));
    return glass;
}

void set_glass(Scene& scene, const Material& glass) {
    for (Material& material : scene.materials) {
        if (!material.refractive()) continue;
        material.ior = glass.ior;
        material.attenuation_color = glass.attenuation_color;
        material.attenuation_distance = glass.attenuation_distance;
    }
}

glm::dmat4 world_from_source(const PlacedSource& placed, const Bounds& bounds) {
    const glm::dmat4 move = glm::translate(glm::dmat4(1.0), placed.position);
    return move * glm::dmat4(placed.rotation) * glm::scale(glm::dmat4(1.0), glm::dvec3(placed.scale)) *
           glm::translate(glm::dmat4(1.0), -glm::dvec3(bounds.center));
}

struct Sphere {
    glm::dvec3 center;
    double radius;
};

/// A centre at which a sphere touches no other; the ball of centres grows until there is one.
glm::dvec3 free_position(DatasetRandom& random, const std::vector<Sphere>& taken, double radius, double spread) {
    constexpr double kGrowth = 1.05, kGap = 1.02;
    for (double ball = std::max(spread, 1e-6);; ball *= kGrowth) {
        const glm::dvec3 center = ball * random.in_unit_ball();
        const bool free = std::all_of(taken.begin(), taken.end(), [&](const Sphere& other) {
            return glm::distance(center, other.center) > kGap * (radius + other.radius);
        });
        if (free) return center;
    }
}

/// A rectangle that faces the camera and is larger than its image, whose part in the image has the coordinates 0..1.
Mesh background_mesh(const Camera& camera, double depth, double aspect) {
    constexpr double kLarger = 6.0;
    const double half_height = depth * std::tan(0.5 * double(camera.vertical_fov));
    const glm::dmat4 world_from_view(camera.world_from_view);
    Mesh mesh;
    mesh.name = "background";
    for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
        const glm::dvec2 film = kLarger * corner * half_height * glm::dvec2(aspect, 1.0);
        mesh.positions.push_back(glm::vec3(world_from_view * glm::dvec4(film, -depth, 1.0)));
        mesh.normals.push_back(glm::vec3(camera.world_from_view[2]));
        mesh.texcoords[0].push_back(glm::vec2(0.5 + 0.5 * kLarger * corner.x, 0.5 - 0.5 * kLarger * corner.y));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

}  // namespace

DatasetRandom::DatasetRandom(std::uint64_t seed, std::uint64_t image)
    : engine_(spread_bits(spread_bits(seed) + image)) {}

double DatasetRandom::uniform() { return double(engine_() >> 11) * 0x1p-53; }

glm::dvec3 DatasetRandom::in_unit_ball() {
    for (;;) {
        const double x = uniform(), y = uniform(), z = uniform();
        const glm::dvec3 point = 2.0 * glm::dvec3(x, y, z) - 1.0;
        if (glm::dot(point, point) <= 1.0) return point;
    }
}

/// Uniform rotation (Shoemake 1992).
glm::dmat3 DatasetRandom::rotation() {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double u = uniform(), a = kTurn * uniform(), b = kTurn * uniform();
    const double s = std::sqrt(1.0 - u), c = std::sqrt(u);
    return glm::mat3_cast(glm::dquat(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b)));
}

DatasetScenes::DatasetScenes(const Recipe& recipe, bool allow_outside) : recipe_(recipe) {
    for (const std::string& source : recipe.sources)
        sources_.try_emplace(source, load_source(recipe, source, allow_outside));
    for (const std::string& name : recipe.backgrounds)
        if (!is_pattern(name)) backgrounds_.try_emplace(name, read_background(located(recipe, name)));
    for (const std::string& name : recipe.environments) {
        const bool file = !std::filesystem::path(name).extension().empty();
        std::string warning;
        environments_.try_emplace(name, load_environment(file ? located(recipe, name) : name, &warning));
        if (!warning.empty()) warnings_.push_back(warning);
    }
    for (const auto& [source, scene] : sources_)
        warnings_.insert(warnings_.end(), scene.warnings.begin(), scene.warnings.end());
}

void DatasetScenes::place(DatasetScene& made, DatasetRandom& random) const {
    std::vector<Sphere> taken;
    for (int i = random.whole_within(recipe_.count); i > 0; --i) {
        PlacedSource placed;
        placed.source = random.pick(recipe_.sources);
        Scene source = sources_.at(placed.source);
        const Bounds bounds = scene_bounds(source);
        const float side = 2.0f * std::max({bounds.half_size.x, bounds.half_size.y, bounds.half_size.z});
        placed.scale = random.within(recipe_.size_m) / double(side);
        placed.half_size = placed.scale * glm::dvec3(bounds.half_size);
        placed.rotation = random.rotation();
        const double radius = placed.scale * double(bounds.radius);
        placed.position = free_position(random, taken, radius, recipe_.spread_m);
        taken.push_back({placed.position, radius});
        placed.glass = random_glass(recipe_, random);
        set_glass(source, placed.glass);
        const glm::mat4 transform(world_from_source(placed, bounds));
        placed.first_object = append_objects(made.scene, source, transform);
        placed.object_count = int(source.objects.size());
        append_objects(made.alone.emplace_back(), source, transform);
        made.placed.push_back(std::move(placed));
    }
}

void DatasetScenes::add_background(DatasetScene& made, DatasetRandom& random, double depth) const {
    made.background_source = random.pick(recipe_.backgrounds);
    Image image = is_pattern(made.background_source) ? make_pattern(made.background_source, random)
                                                     : backgrounds_.at(made.background_source);
    Material material;
    material.name = "background";
    material.unlit = true;
    material.base_color_texture = {.image = 0, .wrap_u = Wrap::kMirror, .wrap_v = Wrap::kMirror};
    Object object;
    object.name = "background";
    made.background.images.push_back(std::move(image));
    made.background.image_names.push_back(made.background_source);
    made.background.materials.push_back(std::move(material));
    made.background.meshes.push_back(background_mesh(made.camera, depth, recipe_.width / recipe_.height));
    made.background.objects.push_back(std::move(object));
    append_objects(made.scene, made.background, glm::mat4(1.0f));
}

DatasetScene DatasetScenes::make(std::uint64_t image) const {
    DatasetRandom random(std::uint64_t(recipe_.seed), image);
    DatasetScene made;
    place(made, random);
    double farthest = 0.0;
    for (const PlacedSource& placed : made.placed)
        farthest = std::max(farthest, glm::length(placed.position) + glm::length(placed.half_size));
    constexpr double kClear = 1.2;
    const double distance = std::max(random.within(recipe_.distance_m), kClear * farthest);
    const double azimuth_deg = 360.0 * random.uniform(), elevation_deg = random.within(recipe_.elevation_deg);
    const float fov = float(glm::radians(random.within(recipe_.fov_deg)));
    made.camera =
        orbit_camera({.center = glm::vec3(0.0f), .radius = 1.0f}, float(azimuth_deg), float(elevation_deg), 2.0f, fov);
    made.camera.world_from_view[3] = glm::vec4(float(distance) * glm::vec3(made.camera.world_from_view[2]), 1.0f);
    add_background(made, random, distance + farthest + random.within(recipe_.background_distance_m));
    made.environment_source = random.pick(recipe_.environments);
    made.environment = environments_.at(made.environment_source);
    made.environment.rotation = float(2.0 * std::numbers::pi * random.uniform());
    made.environment.intensity = float(random.within(recipe_.environment_intensity));
    return made;
}

}  // namespace pellucid::cli
