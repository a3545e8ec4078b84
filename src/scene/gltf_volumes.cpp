#include "scene/gltf_volumes.h"

#include "core/fail.h"
#include "scene/check_scene.h"
#include "scene/volumes/volume_source.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <memory>
#include <utility>

namespace pellucid {
namespace {

constexpr const char* kKey = "pellucid_volume";

}  // namespace

void GltfVolumes::add(const tinygltf::Node& node, const std::string& node_name, const glm::dmat4& world_from_node,
                      std::size_t first_object) {
    if (!node.extras.IsObject() || !node.extras.Has(kKey)) return;
    const tinygltf::Value& value = node.extras.Get(kKey);
    const std::string user = fmt::format("{}: {}", node_name, kKey);
    if (!value.IsString()) fail(gltf_.path, user + " is no string, such as volume:NAME or the path of a .vdb file");
    const auto& source = value.Get<std::string>();
    VolumeObject object;
    object.name = node_name;
    object.world_from_volume = glm::mat4(world_from_node);
    if (!is_similarity(object.world_from_volume))
        fail(gltf_.path, user + ": the node does not scale alike in all directions");
    auto known = volumes_.find(source);
    if (known == volumes_.end()) {
        try {
            scene_.volumes.push_back(std::make_shared<const Volume>(open_volume(source, gltf_.scope)));
        } catch (const Error& error) {
            fail(gltf_.path, fmt::format("{}: {}", user, error.what()));
        }
        known = volumes_.emplace(source, int(scene_.volumes.size()) - 1).first;
    }
    object.volume = known->second;
    for (std::size_t i = first_object; i < scene_.objects.size(); ++i)
        if (scene_.materials[std::size_t(scene_.objects[i].material)].refractive()) object.objects.push_back(int(i));
    scene_.volume_objects.push_back(std::move(object));
}

}  // namespace pellucid
