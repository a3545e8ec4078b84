#pragma once

#include <pellucid/scene.h>

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid {

/// Writers of write_scene(). They add a line to `left_out` for each thing that the format does not hold.
void write_glb(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out);
void write_obj(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out);

}  // namespace pellucid
