#pragma once

// Small scenes in which every kind of surface and light has a part.
#include <pellucid/pellucid.h>

#include <glm/gtc/matrix_transform.hpp>

namespace pellucid::test {

inline void add_shape(Scene& scene, const char* shape, const Material& material, const glm::vec3& position,
                      float scale = 1.0f) {
    const Scene loaded = load_scene(shape);
    scene.meshes.push_back(loaded.meshes.front());
    scene.materials.push_back(material);
    Object object;
    object.mesh = int(scene.meshes.size()) - 1;
    object.material = int(scene.materials.size()) - 1;
    object.world_from_object = glm::scale(glm::translate(glm::mat4(1.0f), position), glm::vec3(scale));
    scene.objects.push_back(object);
}

inline Material opaque_material(float roughness) {
    Material material;
    material.base_color = glm::vec4(0.6f, 0.4f, 0.3f, 1.0f);
    material.roughness = roughness;
    return material;
}

/// A solid of glass over an opaque cube, under a lamp. `shape` as load_scene() names it.
inline Scene table_scene(const char* shape = "shape:goblet,segments=16,rings=24") {
    Scene scene = load_scene(shape);
    add_shape(scene, "shape:cube", opaque_material(1.0f), {0, -2, 0});
    Light lamp;
    lamp.position = {2.0f, 3.0f, 1.0f};
    lamp.intensity = glm::vec3(20.0f);
    lamp.radius = 0.2f;
    scene.lights.push_back(lamp);
    return scene;
}

/// Balls of clear, rough and dispersive glass that touch, cross and hide each other.
inline Scene crowd_scene() {
    Scene scene = load_scene("shape:sphere,segments=24");
    Material glass = scene.materials.front();
    glass.roughness = 0.3f;
    add_shape(scene, "shape:torus,segments=32,sides=16", glass, {0.8f, 0.1f, -1.0f});
    glass.roughness = 0.0f;
    glass.ior = 1.7f;
    glass.dispersion = 0.1f;
    add_shape(scene, "shape:sphere,segments=16", glass, {-1.2f, 0.3f, 0.2f}, 0.5f);
    add_shape(scene, "shape:cube", opaque_material(0.2f), {0, -2, 0});
    return scene;
}

}  // namespace pellucid::test
