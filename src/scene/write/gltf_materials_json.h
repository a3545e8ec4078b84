#pragma once

#include <pellucid/scene.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace pellucid {

/// "materials" of a glTF file, and the "textures" and "samplers" that they use. Image i of the file is Scene::images[i].
struct GltfMaterialsJson {
    nlohmann::json materials = nlohmann::json::array(), textures = nlohmann::json::array(),
                   samplers = nlohmann::json::array();
};
GltfMaterialsJson gltf_materials_json(const Scene& scene, std::vector<std::string>& left_out);

}  // namespace pellucid
