#pragma once

#include <pellucid/pellucid.h>

#include <string>
#include <vector>

namespace pellucid::viewer {

/// One interface that the ray through a pixel meets.
struct InspectedEvent {
    glm::vec3 position{0.0f};    ///< world, m
    bool reflected = false;      ///< totally; otherwise refracted
    float length = 0.0f;         ///< m, from the event before
    float length_inside = 0.0f;  ///< m, inside media so far
};

/// The path of light through the centre of one pixel, as the exact tracer finds it.
struct InspectedRay {
    glm::uvec2 pixel{0};
    std::vector<InspectedEvent> events;
    RefractedPath path;
    glm::vec3 eye{0.0f};  ///< world, m: where the ray starts
    std::string ends_on;  ///< an object's name, or "the environment"
};

/// `scene`: that of the tracer.
InspectedRay inspect(const Tracer& tracer, const Scene& scene, const Camera& camera, glm::uvec2 pixel,
                     std::uint32_t width, std::uint32_t height);

/// Draws the ray with Dear ImGui, over the whole window and below all panels. `bounds`: of the scene.
void draw_ray(const InspectedRay& ray, const Camera& camera, const Bounds& bounds);

}  // namespace pellucid::viewer
