#pragma once

#include "lab/dataset_recipe.h"

#include <pellucid/pellucid.h>

#include <glm/glm.hpp>

#include <map>
#include <random>
#include <string>
#include <vector>

namespace pellucid::cli {

/// Random numbers of one image, the same on every machine.
class DatasetRandom {
public:
    DatasetRandom(std::uint64_t seed, std::uint64_t image);
    double uniform();  ///< 0..1 without 1
    double within(const Range& range) { return range.low + (range.high - range.low) * uniform(); }
    int whole_within(const Range& range) { return int(range.low + uniform() * (range.high - range.low + 1.0)); }
    template <class Item>
    const Item& pick(const std::vector<Item>& items) {
        return items[std::size_t(uniform() * double(items.size()))];
    }
    glm::dvec3 in_unit_ball();
    glm::dmat3 rotation();

private:
    std::mt19937_64 engine_;
};

/// A source in an image. Its own frame has the origin at the centre of the source's box.
struct PlacedSource {
    std::string source;
    int first_object = 0, object_count = 0;  ///< in DatasetScene::scene
    glm::dmat3 rotation{1.0};                ///< world from own frame
    glm::dvec3 position{0.0};                ///< of its centre, world, m
    double scale = 1.0;                      ///< applied to the source before the rotation
    glm::dvec3 half_size{0.0};               ///< half the sides of its box in its own frame, m, scaled
    Material glass;                          ///< the material of its refracting parts
};

struct DatasetScene {
    Scene scene;       ///< background and objects
    Scene background;  ///< the background alone
    Camera camera;
    Environment environment;
    std::string background_source, environment_source;
    std::vector<PlacedSource> placed;
    std::vector<Scene> alone;  ///< each placed source alone, for its whole mask
};

/// Makes scenes of a recipe. Each depends on the recipe and the image's number only.
class DatasetScenes {
public:
    /// Loads every file of the recipe. `allow_outside`: see LoadOptions. Throws Error naming the file.
    explicit DatasetScenes(const Recipe& recipe, bool allow_outside = false);
    DatasetScene make(std::uint64_t image) const;
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    void place(DatasetScene& made, DatasetRandom& random) const;
    void add_background(DatasetScene& made, DatasetRandom& random, double farthest_m) const;

    Recipe recipe_;
    std::map<std::string, Scene> sources_;
    std::map<std::string, Image> backgrounds_;
    std::map<std::string, Environment> environments_;
    std::vector<std::string> warnings_;
};

}  // namespace pellucid::cli
