// The surface map of what the camera sees.
#include "layers/layers.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pellucid {
namespace {

/// A texel covers two by two pixels; similar sizes are as fast. Dense triangles get finer texels, because a ray tests
/// all triangles of each texel that it crosses.
constexpr float kCoarsest = 0.5f;  ///< texels per pixel, along a side
constexpr float kMostTrianglesPerTexel = 16.0f;
constexpr std::uint32_t kMostTexels = 1u << 22;  ///< 90 MB with the pyramid over them

gpu::FrameConstants view_of(const Frame& frame) {
    gpu::FrameConstants view = frame.view;
    view.film.x += float(view.first_x) * view.film.z;  // moves the film from the image's corner to the tile's
    view.film.y -= float(view.first_y) * view.film.w;
    return view;
}

/// The map projection of the view. With parallel rays the depth is q = (z - near) / (far - near). Otherwise 1 / z
/// replaces z, which keeps lines straight.
MapProjection view_projection(const gpu::FrameConstants& view, vk::Extent2D pixels, float texels_per_pixel) {
    const bool parallel = view.orthographic != 0;
    // Rows give X, Y, Q, W of a view-space position; depth is -z.
    const float scale_x = texels_per_pixel / view.film.z, scale_y = texels_per_pixel / view.film.w;
    glm::vec4 x, y, q, w;
    if (parallel) {
        const float scale = 1.0f / (view.far_plane - view.near_plane);
        x = {scale_x, 0.0f, 0.0f, -view.film.x * scale_x};
        y = {0.0f, -scale_y, 0.0f, view.film.y * scale_y};
        q = {0.0f, 0.0f, -scale, -view.near_plane * scale};
        w = {0.0f, 0.0f, 0.0f, 1.0f};
    } else {
        const float scale = view.far_plane / (view.far_plane - view.near_plane);
        x = {scale_x, 0.0f, view.film.x * scale_x, 0.0f};
        y = {0.0f, -scale_y, -view.film.y * scale_y, 0.0f};
        q = {0.0f, 0.0f, -scale, -view.near_plane * scale};
        w = {0.0f, 0.0f, -1.0f, 0.0f};
    }
    const glm::mat4 map_from_view = glm::transpose(glm::mat4(x, y, q, w));
    const auto texels = [&](std::uint32_t side) { return std::uint32_t(std::ceil(float(side) * texels_per_pixel)); };
    return {map_from_view * view.view_from_world,
            parallel ? 0.5f : view.near_plane,
            {texels(pixels.width), texels(pixels.height)}};
}

/// The part of the image that an object's box covers, pixels. The whole image if the box crosses the near plane.
struct PixelBox {
    glm::vec2 low, high;
    float area() const { return high.x > low.x && high.y > low.y ? (high.x - low.x) * (high.y - low.y) : 0.0f; }
};

PixelBox common(const PixelBox& a, const PixelBox& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

PixelBox pixels_of(const GpuScene& scene, std::uint32_t object, const MapProjection& pixels) {
    const PixelBox all{glm::vec2(0.0f), {pixels.extent.width, pixels.extent.height}};
    const GpuMesh& mesh = scene.meshes[scene.mesh_of_object[object]];
    const glm::mat4 to_pixels = pixels.map_from_world * scene.world_from_object[object];
    PixelBox box{all.high, all.low};
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 upper(corner & 1, corner & 2, corner & 4);
        const glm::vec4 p = to_pixels * glm::vec4(glm::mix(mesh.low, mesh.high, glm::vec3(upper)), 1.0f);
        if (p.w < pixels.near_w) return all;
        box = {glm::min(box.low, glm::vec2(p) / p.w), glm::max(box.high, glm::vec2(p) / p.w)};
    }
    return common({box.low, glm::max(box.high, box.low + 1.0f)}, all);
}

/// Texels per pixel that limit the number of triangles per texel over the glass in the image.
float choose_texels(const Frame& frame, const gpu::FrameConstants& view) {
    const GpuScene& scene = frame.scene;
    const MapProjection pixels = view_projection(view, frame.extent, 1.0f);
    const auto triangles_in = [&](std::uint32_t object, const PixelBox& box) {
        const PixelBox own = pixels_of(scene, object, pixels);
        const float area = own.area();
        return area > 0.0f
                   ? float(scene.meshes[scene.mesh_of_object[object]].triangle_count) * common(own, box).area() / area
                   : 0.0f;
    };
    PixelBox glass{glm::vec2(1e30f), glm::vec2(-1e30f)};
    float area = 0.0f, triangles = 0.0f;
    for (const DrawCall& call : scene.refractive) {
        const PixelBox own = pixels_of(scene, call.object, pixels);
        if (own.area() == 0.0f) continue;
        glass = {glm::min(glass.low, own.low), glm::max(glass.high, own.high)};
        area += own.area();
        triangles += triangles_in(call.object, own);
    }
    for (const DrawCall& call : scene.opaque) triangles += triangles_in(call.object, glass);
    float texels = kCoarsest;
    const auto padded = [&](float scale) {
        const MapProjection map = view_projection(view, frame.extent, scale);
        return std::uint64_t(std::bit_ceil(map.extent.width)) * std::bit_ceil(map.extent.height);
    };
    while (triangles > kMostTrianglesPerTexel * area * texels * texels && padded(2.0f * texels) <= kMostTexels)
        texels *= 2.0f;
    return texels;
}

}  // namespace

bool LayerSource::view_holds_glass(const Frame& frame) {
    const gpu::FrameConstants view = view_of(frame);
    const MapProjection pixels = view_projection(view, frame.extent, 1.0f);
    const glm::vec2 size(pixels.extent.width, pixels.extent.height);
    // Automatic clip planes exclude no vertex, even if corners of boxes lie outside the planes.
    const float nearest = view.orthographic != 0 ? 0.0f : std::max(frame.scene.topology->eye_depth, 1e-30f);
    const std::vector<glm::vec3>& corners = frame.scene.refractive_corners;
    return std::all_of(corners.begin(), corners.end(), [&](const glm::vec3& corner) {
        const glm::vec4 p = pixels.map_from_world * glm::vec4(corner, 1.0f);
        return p.w >= nearest && glm::all(glm::greaterThanEqual(glm::vec2(p), glm::vec2(0.0f))) &&
               glm::all(glm::lessThanEqual(glm::vec2(p), size * p.w));
    });
}

SurfaceMap LayerSource::map_view(Recorder& recorder, const Frame& frame) {
    const Recorder::Scope scope(recorder, "layers");
    const gpu::FrameConstants view = view_of(frame);
    return map_surfaces(recorder, frame, *frame.scene.topology,
                        view_projection(view, frame.extent, choose_texels(frame, view)));
}

}  // namespace pellucid
