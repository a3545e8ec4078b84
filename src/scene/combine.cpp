#include "scene/material_textures.h"

#include <pellucid/combine.h>

#include <algorithm>

namespace pellucid {
namespace {

int next_body(const Scene& scene) {
    int next = 0;
    for (const Object& object : scene.objects) next = std::max(next, object.body + 1);
    return next;
}

}  // namespace

int append_objects(Scene& scene, const Scene& added, const glm::mat4& scene_from_added) {
    const int first_image = int(scene.images.size()), first_material = int(scene.materials.size());
    const int first_mesh = int(scene.meshes.size()), first_object = int(scene.objects.size());
    const int first_body = next_body(scene);
    scene.images.insert(scene.images.end(), added.images.begin(), added.images.end());
    scene.image_names.insert(scene.image_names.end(), added.image_names.begin(), added.image_names.end());
    for (Material material : added.materials) {
        for (Texture* texture : mutable_textures_of(material))
            if (texture->image >= 0) texture->image += first_image;
        scene.materials.push_back(std::move(material));
    }
    scene.meshes.insert(scene.meshes.end(), added.meshes.begin(), added.meshes.end());
    for (Object object : added.objects) {
        object.mesh += first_mesh;
        object.material += first_material;
        if (object.body >= 0) object.body += first_body;
        object.world_from_object = scene_from_added * object.world_from_object;
        scene.objects.push_back(std::move(object));
    }
    return first_object;
}

}  // namespace pellucid
