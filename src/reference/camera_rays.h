#pragma once

// View rays of a camera in double precision, through any point of the image.

#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace pellucid::reference {

/// A view ray, starting at the camera's view volume.
struct CameraRay {
    glm::dvec3 origin{0.0};     ///< world, m: on the near plane; at the eye if the camera has no near plane
    glm::dvec3 direction{0.0};  ///< unit, world
    double before = 0.0;        ///< m from the eye (orthographic: from the camera's plane) to `origin`
    double t_max = std::numeric_limits<double>::infinity();  ///< m from `origin` to the far plane
};

class CameraRays {
public:
    /// `camera` must be checked (check_camera).
    CameraRays(const Camera& camera, std::uint32_t width, std::uint32_t height)
        : world_from_view_(camera.world_from_view), half_size_(0.5 * double(width), 0.5 * double(height)),
          orthographic_(camera.orthographic), near_(camera.near_plane) {
        const double extent =
            orthographic_ ? double(camera.vertical_extent) : 2.0 * std::tan(0.5 * double(camera.vertical_fov));
        pixel_ = extent / double(height);
        if (camera.far_plane > 0.0f) far_ = double(camera.far_plane);
    }

    /// Ray through a point of the image, in pixels from its top left corner. (0.5, 0.5) is the centre of the first
    /// pixel.
    CameraRay at(glm::dvec2 point_px) const {
        const glm::dvec2 film = (point_px - half_size_) * glm::dvec2(pixel_, -pixel_);
        const glm::dvec3 eye = orthographic_ ? glm::dvec3(film, 0.0) : glm::dvec3(0.0);
        const glm::dvec3 along = orthographic_ ? glm::dvec3(0.0, 0.0, -1.0) : glm::dvec3(film, -1.0);
        const double stretch = glm::length(along);  // metres along the ray per metre of depth
        CameraRay ray;
        ray.before = near_ * stretch;
        ray.direction = glm::normalize(glm::dmat3(world_from_view_) * along);
        ray.origin = glm::dvec3(world_from_view_ * glm::dvec4(eye + near_ * along, 1.0));
        ray.t_max = (far_ - near_) * stretch;
        return ray;
    }

    /// Side of a pixel, m, at a visible position in world space.
    double pixel_size(const glm::dvec3& position) const {
        const double depth = glm::dot(glm::dvec3(world_from_view_[3]) - position, glm::dvec3(world_from_view_[2]));
        return orthographic_ ? pixel_ : pixel_ * std::abs(depth);
    }

    /// True if every ray starts at the same point.
    bool one_origin() const { return !orthographic_ && near_ == 0.0; }

private:
    glm::dmat4 world_from_view_;
    glm::dvec2 half_size_;
    bool orthographic_;
    double near_;
    double far_ = std::numeric_limits<double>::infinity();
    double pixel_ = 0.0;
};

}  // namespace pellucid::reference
