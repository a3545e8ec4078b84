#pragma once

#include "scene/tinygltf.h"
#include "scene/warnings.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string_view>

namespace pellucid {

/// The JSON of a glTF file. Throws Error if it is none, if its version is not 2, and for required extensions that are
/// refused. Extensions that are left out give a warning.
nlohmann::json parse_gltf_json(const std::filesystem::path& path, std::string_view text, Warnings& warnings);

/// tinygltf's model of the JSON, without buffers and images. Throws Error.
tinygltf::Model gltf_model(const std::filesystem::path& path, nlohmann::json root, Warnings& warnings);

}  // namespace pellucid
