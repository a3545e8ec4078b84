#include "viewer/inspector.h"

#include <imgui.h>

#include <cmath>

namespace pellucid::viewer {
namespace {

constexpr std::uint32_t kMostEvents = 64;

glm::vec3 primary_direction(const Camera& camera, glm::uvec2 pixel, std::uint32_t width, std::uint32_t height) {
    const glm::vec2 share = (2.0f * (glm::vec2(pixel) + 0.5f) - glm::vec2(width, height)) / float(height);
    const float half = std::tan(0.5f * camera.vertical_fov);
    const glm::vec3 view(share.x * half, -share.y * half, -1.0f);
    return glm::normalize(glm::mat3(camera.world_from_view) * (camera.orthographic ? glm::vec3(0, 0, -1) : view));
}

/// The point of the first line nearest to the second.
glm::vec3 meeting_point(const glm::vec3& a, const glm::vec3& along_a, const glm::vec3& b, const glm::vec3& along_b) {
    const float cosine = glm::dot(along_a, along_b), sine_squared = 1.0f - cosine * cosine;
    if (sine_squared < 1e-12f) return b;
    const glm::vec3 between = b - a;
    return a + along_a * ((glm::dot(between, along_a) - cosine * glm::dot(between, along_b)) / sine_squared);
}

/// Position in an image of the given size, pixels from the top left; z is positive in front of the camera.
glm::vec3 project(const glm::vec3& world, const Camera& camera, float width, float height) {
    const glm::vec3 view = glm::inverse(camera.world_from_view) * glm::vec4(world, 1.0f);
    const float half = camera.orthographic ? 0.5f * camera.vertical_extent
                                           // half the image's height at that depth, m
                                           : -view.z * std::tan(0.5f * camera.vertical_fov);
    const float scale = half != 0.0f ? 0.5f * height / half : 0.0f;
    return {0.5f * width + view.x * scale, 0.5f * height - view.y * scale, -view.z};
}

}  // namespace

InspectedRay inspect(const Tracer& tracer, const Scene& scene, const Camera& camera, glm::uvec2 pixel,
                     std::uint32_t width, std::uint32_t height) {
    ExactSettings settings;
    settings.width = width;
    settings.height = height;
    settings.part_first = pixel;
    settings.part_size = {1, 1};
    const auto trace = [&](std::uint32_t events) {
        settings.max_events = events;
        return tracer.exact(camera, settings).front();
    };
    InspectedRay ray;
    ray.pixel = pixel;
    ray.eye = camera.world_from_view[3];
    ray.path = trace(kMostEvents);
    glm::vec3 from = ray.eye;
    std::uint16_t reflections = 0;
    glm::vec3 direction = ray.path.direction;
    // A path with fewer allowed events stops at the last one.
    for (std::uint32_t i = 1; i <= ray.path.events; ++i) {
        const bool last = i == ray.path.events;
        const RefractedPath part = last ? ray.path : trace(i);
        glm::vec3 position = part.position;
        if (last && ray.path.object >= 0) {
            if (i == 1) direction = primary_direction(camera, pixel, width, height);
            position = meeting_point(from, direction, ray.path.position, ray.path.direction);
        }
        ray.events.push_back(
            {position, part.reflections > reflections, glm::distance(position, from), part.length_inside});
        reflections = part.reflections;
        direction = part.direction;
        from = position;
    }
    ray.ends_on = ray.path.object >= 0 ? one_line(scene.objects[std::size_t(ray.path.object)].name) : "the environment";
    return ray;
}

void draw_ray(const InspectedRay& ray, const Camera& camera, const Bounds& bounds) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const glm::vec2 start(float(ray.pixel.x) + 0.5f, float(ray.pixel.y) + 0.5f);
    list.AddCircle({start.x, start.y}, 5.0f, IM_COL32(255, 255, 0, 255));
    std::vector<glm::vec3> points;
    for (const InspectedEvent& event : ray.events) points.push_back(event.position);
    const RefractedPath& path = ray.path;
    if (path.object >= 0)
        points.push_back(path.position);
    else if (!points.empty())
        points.push_back(points.back() + bounds.radius * path.direction);
    glm::vec3 from(start, 1.0f);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 to = project(points[i], camera, size.x, size.y);
        if (to.z <= 0.0f || from.z <= 0.0f) break;
        const bool after_reflection = i > 0 && ray.events[i - 1].reflected;
        const ImU32 color = i == 0                   ? IM_COL32(255, 255, 0, 255)
                            : i + 1 == points.size() ? IM_COL32(90, 220, 255, 255)
                            : after_reflection       ? IM_COL32(120, 255, 120, 255)
                                                     : IM_COL32(255, 140, 60, 255);
        list.AddLine({from.x, from.y}, {to.x, to.y}, color, 2.0f);
        if (i < ray.events.size()) list.AddCircleFilled({to.x, to.y}, 3.5f, color);
        from = to;
    }
}

}  // namespace pellucid::viewer
