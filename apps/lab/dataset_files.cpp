#include "lab/dataset_sample.h"
#include "options/options.h"

#include <pellucid/file.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace pellucid::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Appends the values of one pixel in the order of sample_channels().
class PixelWriter {
public:
    explicit PixelWriter(float* to) : to_(to) {}
    void add(float value) { *to_++ = value; }
    void add(const glm::vec3& vector) {
        for (int c = 0; c < 3; ++c) add(vector[c]);
    }
    void add(const float* values, int count) { to_ = std::copy_n(values, count, to_); }

private:
    float* to_;
};

Image all_channels(const DatasetScene& made, const DatasetSample& sample) {
    const Image& radiance = sample.with_glass.radiance;
    const glm::mat4 view_from_world = glm::inverse(made.camera.world_from_view);
    const auto depth = [&](const glm::vec3& position) { return -(view_from_world * glm::vec4(position, 1.0f)).z; };
    Image image(radiance.width, radiance.height, int(sample_channels().size()));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
            const SurfacePath& path = sample.paths[i];
            PixelWriter pixel(image.at(x, y));
            pixel.add(radiance.at(x, y), 3);
            pixel.add(sample.without_glass.radiance.at(x, y), 3);
            pixel.add(sample.flow.at(x, y), 3);
            pixel.add(path.attenuation);
            pixel.add(path.fresnel);
            for (const PathSurface* surface : {&path.first, &path.second, &path.last})
                pixel.add(surface->object >= 0 ? depth(surface->position) : 0.0f);
            const RefractedPath& behind = sample.background[i];
            pixel.add(behind.object >= 0 ? depth(behind.position) : 0.0f);
            for (const PathSurface* surface : {&path.first, &path.second, &path.last})
                pixel.add(glm::mat3(view_from_world) * surface->normal);
            pixel.add(float(path.path.events));
            pixel.add(float(path.path.reflections));
            pixel.add(float(path.path.status));
            pixel.add(float(sample.instances[i]));
        }
    return image;
}

Json rows(const glm::dmat3& m) {
    Json json = Json::array();
    for (int row = 0; row < 3; ++row) json.push_back({m[0][row], m[1][row], m[2][row]});
    return json;
}

Json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Pixels of a mask and their box: x, y, width, height.
struct MaskBox {
    std::uint64_t pixels = 0;
    int left = 0, top = 0, right = -1, bottom = -1;

    void add(int x, int y) {
        if (pixels++ == 0) {
            left = right = x;
            top = y;
        }
        left = std::min(left, x);
        right = std::max(right, x);
        bottom = y;
    }
    Json box() const { return {left, top, right - left + 1, bottom - top + 1}; }
};

template <class Inside>
MaskBox box_of(int width, int height, Inside inside) {
    MaskBox box;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (inside(std::size_t(y) * std::size_t(width) + std::size_t(x))) box.add(x, y);
    return box;
}

/// COCO's uncompressed run lengths: columns first, beginning with pixels outside.
template <class Inside>
Json run_lengths(int width, int height, Inside inside) {
    Json counts = Json::array();
    std::uint64_t run = 0;
    bool now = false;
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y, ++run) {
            if (inside(std::size_t(y) * std::size_t(width) + std::size_t(x)) == now) continue;
            counts.push_back(run);
            run = 0;
            now = !now;
        }
    counts.push_back(run);
    return {{"size", {height, width}}, {"counts", counts}};
}

/// Axes right, down and forward, as computer vision has them.
glm::dmat4 vision_from_world(const Camera& camera) {
    const glm::dmat4 turn(glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1));
    return turn * glm::inverse(glm::dmat4(camera.world_from_view));
}

Json describe_camera(const Camera& camera, double width, double height) {
    const double focal = 0.5 * height / std::tan(0.5 * double(camera.vertical_fov));
    const glm::dmat4 m = vision_from_world(camera);
    return {{"K", {{focal, 0.0, 0.5 * width}, {0.0, focal, 0.5 * height}, {0.0, 0.0, 1.0}}},
            {"rotation_from_world", rows(glm::dmat3(m))},
            {"translation_from_world_m", numbers(m[3])},
            {"vertical_fov", camera.vertical_fov}};
}

Json describe_object(const DatasetScene& made, const DatasetSample& sample, std::size_t index) {
    const PlacedSource& placed = made.placed[index];
    const int width = sample.flow.width, height = sample.flow.height, id = int(index) + 1;
    const auto seen = [&](std::size_t i) { return sample.instances[i] == id; };
    const MaskBox visible = box_of(width, height, seen);
    const auto alone = [&](std::size_t i) { return sample.whole_masks[index][i] != 0; };
    const MaskBox whole = box_of(width, height, alone);
    const glm::dmat4 camera = vision_from_world(made.camera);
    const Material& glass = placed.glass;
    Json json{{"id", id},
              {"source", placed.source},
              {"ior", glass.ior},
              {"attenuation_color", numbers(glass.attenuation_color)},
              {"rotation", rows(glm::dmat3(camera) * placed.rotation)},
              {"translation_m", numbers(glm::dvec3(camera * glm::dvec4(placed.position, 1.0)))},
              {"scale", placed.scale},
              {"half_size_m", numbers(placed.half_size)},
              {"visible_pixels", visible.pixels},
              {"whole_pixels", whole.pixels},
              {"visible_box", visible.box()},
              {"whole_box", whole.box()},
              {"segmentation", run_lengths(width, height, seen)},
              {"whole_segmentation", run_lengths(width, height, alone)}};
    if (std::isfinite(glass.attenuation_distance)) json["attenuation_distance_m"] = glass.attenuation_distance;
    return json;
}

Json describe(std::uint64_t number, const Recipe& recipe, const DatasetScene& made, const DatasetSample& sample) {
    Json json{{"image", number},
              {"seed", std::uint64_t(recipe.seed)},
              {"version", version()},
              {"width", sample.flow.width},
              {"height", sample.flow.height},
              {"camera", describe_camera(made.camera, recipe.width, recipe.height)},
              {"background", made.background_source},
              {"environment", made.environment_source},
              {"objects", Json::array()}};
    for (std::size_t i = 0; i < made.placed.size(); ++i) json["objects"].push_back(describe_object(made, sample, i));
    json["warnings"] = sample.with_glass.warnings;
    return json;
}

Image mask_image(const DatasetSample& sample) {
    Image image(sample.flow.width, sample.flow.height, 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = float(sample.instances[i]) / 255.0f;
    return image;
}

}  // namespace

const std::vector<std::string>& sample_channels() {
    static const std::vector<std::string> names{"R",
                                                "G",
                                                "B",
                                                "background.R",
                                                "background.G",
                                                "background.B",
                                                "flow.X",
                                                "flow.Y",
                                                "flow.valid",
                                                "attenuation.R",
                                                "attenuation.G",
                                                "attenuation.B",
                                                "fresnel",
                                                "depth.first",
                                                "depth.second",
                                                "depth.last",
                                                "depth.background",
                                                "normal_first.X",
                                                "normal_first.Y",
                                                "normal_first.Z",
                                                "normal_second.X",
                                                "normal_second.Y",
                                                "normal_second.Z",
                                                "normal_last.X",
                                                "normal_last.Y",
                                                "normal_last.Z",
                                                "events",
                                                "reflections",
                                                "status",
                                                "instance"};
    return names;
}

void write_sample(const std::filesystem::path& folder, std::uint64_t number, const Recipe& recipe,
                  const DatasetScene& made, const DatasetSample& sample) {
    const std::string name = sample_name(number);
    write_image(folder / (name + ".exr"), all_channels(made, sample), sample_channels());
    write_image(folder / (name + ".png"), sample.with_glass.display);
    write_image(folder / (name + ".background.png"), sample.without_glass.display);
    write_image(folder / (name + ".mask.png"), mask_image(sample));
    write_text_file(folder / (name + ".json"), describe(number, recipe, made, sample).dump() + "\n");
}

nlohmann::ordered_json coco_annotations(const std::vector<nlohmann::ordered_json>& images) {
    Json coco{{"images", Json::array()}, {"annotations", Json::array()}, {"categories", Json::array()}};
    std::map<std::string, int> categories;
    for (const Json& image : images)
        for (const Json& object : image["objects"]) categories.try_emplace(object["source"].get<std::string>(), 0);
    for (int next = 1; auto& [source, id] : categories) {
        id = next++;
        coco["categories"].push_back({{"id", id}, {"name", source}, {"supercategory", "transparent"}});
    }
    std::uint64_t annotation = 0;
    for (const Json& image : images) {
        const auto number = image["image"].get<std::uint64_t>();
        coco["images"].push_back({{"id", number},
                                  {"file_name", sample_name(number) + ".png"},
                                  {"width", image["width"]},
                                  {"height", image["height"]}});
        for (const Json& object : image["objects"]) {
            if (object["visible_pixels"] == 0) continue;  // outside of the image, or hidden
            coco["annotations"].push_back({{"id", ++annotation},
                                           {"image_id", number},
                                           {"category_id", categories.at(object["source"].get<std::string>())},
                                           {"bbox", object["visible_box"]},
                                           {"area", object["visible_pixels"]},
                                           {"iscrowd", 0},
                                           {"segmentation", object["segmentation"]}});
        }
    }
    return coco;
}

}  // namespace pellucid::cli
