#pragma once

#include <pellucid/pellucid.h>

#include <string>
#include <vector>

namespace pellucid::viewer {

/// One interface on the ray through a pixel.
struct InspectedEvent {
    glm::vec3 position{0.0f};    ///< world, m
    bool reflected = false;      ///< true: total internal reflection; false: refraction
    float length = 0.0f;         ///< m, from the previous event
    float length_inside = 0.0f;  ///< m, inside media so far
};

/// The exact light path through the centre of one pixel.
struct InspectedRay {
    glm::uvec2 pixel{0};
    std::vector<InspectedEvent> events;
    RefractedPath path;
    glm::vec3 eye{0.0f};  ///< world, m: start of the ray
    std::string ends_on;  ///< an object's name, or "the environment"
};

/// Traces the ray of a pixel. `scene`: the scene of the tracer.
InspectedRay inspect(const Tracer& tracer, const Scene& scene, const Camera& camera, glm::uvec2 pixel,
                     std::uint32_t width, std::uint32_t height);

/// Draws the ray with Dear ImGui, over the whole window and below all panels. `bounds`: of the scene.
void draw_ray(const InspectedRay& ray, const Camera& camera, const Bounds& bounds);

}  // namespace pellucid::viewer
