#pragma once

#include "lab/dataset_scene.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::cli {

/// One image of a data set.
struct DatasetSample {
    RenderResult with_glass, without_glass;
    std::vector<SurfacePath> paths;                      ///< of the scene, one per pixel
    std::vector<RefractedPath> background;               ///< of the background alone
    Image flow;                                          ///< refractive_flow()
    std::vector<int> instances;                          ///< per pixel: placed source from 1, 0: none
    std::vector<std::vector<std::uint8_t>> whole_masks;  ///< per placed source: 1 where it would be seen alone
};

DatasetSample make_sample(const Recipe& recipe, const DatasetScene& made, Renderer& renderer, std::uint32_t threads);

/// Channels of the EXR file of an image.
const std::vector<std::string>& sample_channels();

/// Writes NUMBER.exr, .png, .background.png, .mask.png, and last .json, into the folder.
void write_sample(const std::filesystem::path& folder, std::uint64_t image, const Recipe& recipe,
                  const DatasetScene& made, const DatasetSample& sample);

/// Name of an image's files without extension, "000012".
std::string sample_name(std::uint64_t image);

/// COCO's instances: images, annotations with boxes, areas and run lengths, and categories. `images`: what the .json
/// files of the images hold.
nlohmann::ordered_json coco_annotations(const std::vector<nlohmann::ordered_json>& images);

}  // namespace pellucid::cli
