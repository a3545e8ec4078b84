// Layers from a surface map of the view: triangles are rasterised in compute, for all techniques that then walk the
// map, and for devices on which that is faster than rasterising fragments.
#include "layers/layer_images.h"
#include "layers/pixel_list.h"

#include <array>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::uint32_t kListMapped[] = {
#include "list_mapped.comp.inc"
};
constexpr std::uint32_t kSelectMapped[] = {
#include "select_mapped.comp.inc"
};

/// Pixels along a side of a texel; anything near it is as right, see docs/performance.md.
constexpr std::uint32_t kTexelSide = 2;

}  // namespace

/// The view as a map: texels are squares of pixels. Depth is q = (z - near) / (far - near) where rays are parallel; otherwise
/// 1 / z takes the place of z, which keeps lines straight.
MapProjection view_projection(const Frame& frame) {
    gpu::FrameConstants view{};
    std::memcpy(&view, frame.constants.mapped(), sizeof(view));
    const bool parallel = view.orthographic != 0;
    // Rows give X, Y, Q, W of a view-space position; depth is -z.
    const float pixel_x = 1.0f / (view.film.z * kTexelSide), pixel_y = 1.0f / (view.film.w * kTexelSide);
    glm::vec4 x, y, q, w;
    if (parallel) {
        const float scale = 1.0f / (view.far_plane - view.near_plane);
        x = {pixel_x, 0.0f, 0.0f, -view.film.x * pixel_x};
        y = {0.0f, -pixel_y, 0.0f, view.film.y * pixel_y};
        q = {0.0f, 0.0f, -scale, -view.near_plane * scale};
        w = {0.0f, 0.0f, 0.0f, 1.0f};
    } else {
        const float scale = view.far_plane / (view.far_plane - view.near_plane);
        x = {pixel_x, 0.0f, view.film.x * pixel_x, 0.0f};
        y = {0.0f, -pixel_y, -view.film.y * pixel_y, 0.0f};
        q = {0.0f, 0.0f, -scale, -view.near_plane * scale};
        w = {0.0f, 0.0f, -1.0f, 0.0f};
    }
    const glm::mat4 map_from_view = glm::transpose(glm::mat4(x, y, q, w));
    const glm::vec4 forward = -view.world_from_view[2];
    return {map_from_view * view.view_from_world,
            parallel ? glm::vec4(-glm::vec3(forward), 0.0f) : view.world_from_view[3],
            parallel ? 0.5f : view.near_plane,
            {(frame.extent.width + kTexelSide - 1) / kTexelSide, (frame.extent.height + kTexelSide - 1) / kTexelSide}};
}

Layers LayerSource::select_from_map(Recorder& recorder, const Frame& frame, const Opaque& opaque,
                                    const LayerRequest& request) {
    if (!mapped_) map_.emplace(map_surfaces(recorder, frame, *frame.scene.topology, view_projection(frame)));
    // All solids, or one.
    std::uint32_t first_triangle = 0, end_triangle = PELLUCID_NO_TRIANGLE;
    if (request.solids.size() == 1) {
        first_triangle = frame.scene.first_triangles[request.solids[0].object];
        end_triangle = first_triangle + request.solids[0].corner_count / 3;
    }
    const LayerImages images = allocate_layers(frame, request);
    recorder.clear(images.depth, vk::ClearColorValue(std::array{float(PELLUCID_EMPTY_DEPTH), 0.0f, 0.0f, 0.0f}));
    recorder.clear(images.triangle, vk::ClearColorValue(std::array{PELLUCID_NO_TRIANGLE, 0u, 0u, 0u}));
    const Buffer& any = start_pixel_list(recorder, frame, "mapped pixels");
    recorder.compute(frame.workspace.compute({"list_mapped.comp", kListMapped}),
                     {reads("Texels", *map_->texels), reads("Maps", *map_->maps), updates("PixelList", any)},
                     std::array{frame.extent.width, frame.extent.height, kTexelSide}, frame.extent);
    recorder.compute_indirect(
        frame.workspace.compute({"select_mapped.comp", kSelectMapped}),
        {reads("Frame", frame.constants), reads("Objects", frame.scene.objects), reads("Indices", frame.scene.indices),
         reads("Vertices", frame.scene.vertices), reads("PixelList", any), reads("Maps", *map_->maps),
         reads("map_triangles", *map_->triangles), reads("records", *map_->records), reads("texels", *map_->texels),
         reads("opaque_depth", opaque.depth), writes("layer_depth", images.depth),
         writes("layer_triangle", images.triangle), writes("layer_normal", images.normal)},
        std::array{request.count, request.hidden_by_opaque ? 1u : 0u, first_triangle, end_triangle, kTexelSide}, any);
    const Buffer& covered = list_pixels(recorder, frame, images.triangle, PELLUCID_NO_TRIANGLE,
                                        request.name + " pixels", 0, frame.extent.height);
    return {images.depth, images.triangle, images.normal, covered, request.count, opaque, *this};
}

}  // namespace pellucid
