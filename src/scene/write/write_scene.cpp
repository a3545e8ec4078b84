#include <pellucid/write_scene.h>

#include "core/fail.h"
#include "scene/warnings.h"
#include "scene/write/scene_writers.h"

#include <pellucid/file.h>

#include <fmt/format.h>

namespace pellucid {

std::vector<std::string> write_scene(const std::filesystem::path& file, const Scene& scene) {
    const std::string extension = lower_extension(file);
    if (extension != ".glb" && extension != ".obj")
        fail(file, fmt::format("cannot write scenes as \"{}\" (known: .glb, .obj)", extension));
    if (scene.objects.empty()) fail(file, "cannot write a scene without objects");
    check_writable(file);
    std::vector<std::string> left_out;
    if (!scene.volume_objects.empty())
        left_out.push_back(fmt::format("{} volumes left out; 'pellucid volume' writes them as OpenVDB files",
                                       scene.volume_objects.size()));
    if (scene.rig) left_out.emplace_back("animations left out; the scene is written as it is posed");
    if (extension == ".glb")
        write_glb(file, scene, left_out);
    else
        write_obj(file, scene, left_out);
    return left_out;
}

}  // namespace pellucid
