#include "scene/translucency.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <cmath>

namespace pellucid {

void check_translucency(const Translucency& translucency) {
    const glm::vec3 c = translucency.color;
    for (int k = 0; k < 3; ++k) {
        if (!(c[k] >= 0.0f && c[k] <= 1.0f))
            throw Error(fmt::format("colour of translucency {} {} {}: must be within 0..1", c.r, c.g, c.b));
    }
    if (!(translucency.distance > 0.0f && std::isfinite(translucency.distance)))
        throw Error(fmt::format("distance of translucency {}: must be greater than 0", translucency.distance));
}

void make_translucent(Scene& scene, const Translucency& translucency) {
    check_translucency(translucency);
    for (Material& material : scene.materials) {
        const bool was_glass = material.transmissive();
        material.transmission = 0.0f;
        material.transmission_texture = {};
        material.metallic = 0.0f;
        material.unlit = false;
        if (was_glass) material.roughness = 0.5f;  // smooth surfaces would reflect the environment's lamps
        material.diffuse_transmission = 0.5f;
        material.diffuse_transmission_color = glm::vec3(material.base_color);
        material.attenuation_color = translucency.color;
        material.attenuation_distance = translucency.distance;
        if (!(material.thickness > 0.0f)) material.thickness = 1.0f;  // glTF requires a thickness for volumes
    }
}

}  // namespace pellucid
