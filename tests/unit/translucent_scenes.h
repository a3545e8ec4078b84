#pragma once

// Translucent scenes with a light, whose thickness is known.
#include "core/math.h"
#include "unit/built_scenes.h"

#include <pellucid/scene.h>
#include <pellucid/thickness.h>

#include <cmath>

namespace pellucid::test {

/// One that reflects nothing of the environment, so that what is seen is light that came through.
inline Material wax(glm::vec3 color = glm::vec3(0.5f), float distance = 1.0f) {
    Material material;
    material.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    material.ior = 1.0f;
    material.roughness = 1.0f;
    material.thickness = 1.0f;
    material.diffuse_transmission = 1.0f;
    material.attenuation_color = color;
    material.attenuation_distance = distance;
    return material;
}

inline Light sun(glm::vec3 direction, glm::vec3 intensity = glm::vec3(1.0f)) {
    Light light;
    light.kind = Light::Kind::kDirectional;
    light.direction = glm::normalize(direction);
    light.intensity = intensity;
    return light;
}
inline Light lamp(glm::vec3 position, glm::vec3 intensity = glm::vec3(1.0f)) {
    Light light;
    light.kind = Light::Kind::kPoint;
    light.position = position;
    light.intensity = intensity;
    return light;
}
inline Light spot(glm::vec3 position, glm::vec3 direction, float outer) {
    Light light = lamp(position);
    light.kind = Light::Kind::kSpot;
    light.direction = glm::normalize(direction);
    light.outer_cone_angle = outer;
    return light;
}

/// A shape of load_scene() in wax.
inline Scene waxen(const std::string& source, const Light& light, const Material& material = wax()) {
    Scene scene = load_scene(source);
    scene.materials.assign(1, material);
    scene.lights.push_back(light);
    return scene;
}

inline Scene& add_copy(Scene& scene, const glm::mat4& world_from_object) {
    Object copy = scene.objects.front();
    copy.world_from_object = world_from_object * copy.world_from_object;
    scene.objects.push_back(copy);
    return scene;
}

inline Scene scaled(Scene scene, float factor) {
    for (Object& object : scene.objects)
        object.world_from_object = glm::scale(glm::mat4(1.0f), glm::vec3(factor)) * object.world_from_object;
    for (Material& material : scene.materials) material.attenuation_distance *= factor;
    for (Light& light : scene.lights) light.position *= factor;
    return scene;
}

inline glm::mat4 moved(glm::vec3 by) { return glm::translate(glm::mat4(1.0f), by); }

/// Share of the pixels with a thickness, and of those with one of 0.
struct ThicknessShares {
    int translucent = 0, lit = 0;
};
inline ThicknessShares shares(const Image& thickness) {
    ThicknessShares count;
    for (const float d : thickness.pixels) {
        count.translucent += d >= 0.0f ? 1 : 0;
        count.lit += d == 0.0f ? 1 : 0;
    }
    return count;
}

}  // namespace pellucid::test
