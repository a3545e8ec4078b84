#include "reference/float_trace.h"

#include "reference/exact_refraction.h"
#include "reference/picture_tiles.h"
#include "reference/start_media.h"
#include "scene/check_scene.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace pellucid::reference {
namespace {

/// Start offset of a ray, relative to the largest coordinate: about 32 times its rounding error.
constexpr float kStep = 32.0f * 0x1p-23f;

/// View rays of CameraRays in single precision. Origin and unnormalised direction are linear in the pixel.
class FloatRays {
public:
    FloatRays(const Camera& camera, const ExactSettings& settings) : near_(camera.near_plane) {
        const glm::mat3 world_from_view(camera.world_from_view);
        const float extent = camera.orthographic ? camera.vertical_extent : 2.0f * std::tan(0.5f * camera.vertical_fov);
        const float pixel = extent / float(settings.height);
        const glm::vec2 corner =
            0.5f + glm::vec2(settings.shift_px) - 0.5f * glm::vec2(float(settings.width), float(settings.height));
        const glm::vec3 right = pixel * world_from_view[0], down = -pixel * world_from_view[1];
        const glm::vec3 film = corner.x * right + corner.y * down;
        direction_ = -world_from_view[2];
        origin_ = glm::vec3(camera.world_from_view[3]) + near_ * direction_;
        depth_ = camera.far_plane > 0.0f ? camera.far_plane - near_ : std::numeric_limits<float>::infinity();
        // A step of one pixel to the right moves the origin and turns the direction; in perspective the origin moves
        // by that much per metre.
        const float turn = camera.orthographic ? 0.0f : 1.0f, move = camera.orthographic ? 1.0f : near_;
        direction_ += turn * film;
        origin_ += move * film;
        turn_ = {turn * right, turn * down};
        move_ = {move * right, move * down};
    }

    struct Ray {
        glm::vec3 origin, direction;
        float t_max;
    };
    Ray at(glm::uvec2 pixel) const {
        const glm::vec2 p(pixel);
        const glm::vec3 along = direction_ + p.x * turn_[0] + p.y * turn_[1];
        const float stretch = glm::length(along);
        return {origin_ + p.x * move_[0] + p.y * move_[1], along / stretch, depth_ * stretch};
    }

private:
    float near_, depth_ = 0.0f;
    glm::vec3 origin_{0.0f}, direction_{0.0f};  ///< for the centre of the first pixel; per metre of depth
    std::array<glm::vec3, 2> move_{}, turn_{};  ///< change per pixel, right and down
};

/// The solids around a path, as in MediumStack, but eight at most. Further solids are ignored.
struct Media {
    static constexpr std::uint32_t kMost = 8;
    struct Entry {
        std::int32_t solid, count;
    };
    std::array<Entry, kMost> entries{};
    std::uint32_t size = 0;
    std::int32_t inside = kAir;

    void set(std::int32_t solid, std::int32_t count, const Geometry& geometry) {
        std::uint32_t i = 0;
        while (i < size && entries[i].solid != solid) ++i;
        if (i == kMost) return;
        entries[i] = {solid, count};
        if (i == size) ++size;
        if (count == 0) entries[i] = entries[--size];
        inside = kAir;
        for (i = 0; i < size; ++i) {
            if (entries[i].count <= 0) continue;
            const std::span<const Solid> solids = geometry.solids();
            if (inside == kAir ||
                solids[std::size_t(entries[i].solid)].precedence > solids[std::size_t(inside)].precedence)
                inside = entries[i].solid;
        }
    }
    void cross(std::int32_t solid, bool entering, const Geometry& geometry) {
        std::int32_t count = 0;
        for (std::uint32_t i = 0; i < size; ++i)
            if (entries[i].solid == solid) count = entries[i].count;
        const bool closed = geometry.solids()[std::size_t(solid)].closed;  // for an open solid only the side counts
        set(solid, closed ? count + (entering ? 1 : -1) : (entering ? 1 : 0), geometry);
    }
    const Medium* medium(const Geometry& geometry) const {
        return inside == kAir ? nullptr : &geometry.solids()[std::size_t(inside)].medium;
    }
    float ior(const Geometry& geometry, int channel) const {
        return inside == kAir ? 1.0f : float(medium(geometry)->ior[channel]);
    }
};

Media media_of(const MediumStack& stack, const Geometry& geometry) {
    Media media;
    for (std::uint32_t solid = 0; solid < geometry.solids().size(); ++solid)
        if (stack.count(solid) != 0) media.set(std::int32_t(solid), stack.count(solid), geometry);
    return media;
}

/// Refracts or totally reflects `d` at a boundary. `n`: unit normal on the side that `d` comes from.
glm::vec3 bend(const glm::vec3& d, const glm::vec3& n, float n_i, float n_t) {
    if (n_i == n_t) return d;
    const float cos_i = std::clamp(-glm::dot(d, n), 0.0f, 1.0f), eta = n_i / n_t;
    const float sin2_t = eta * eta * (1.0f - cos_i * cos_i);
    if (sin2_t > 1.0f) return glm::normalize(d + 2.0f * cos_i * n);
    return glm::normalize(eta * d + (eta * cos_i - std::sqrt(1.0f - sin2_t)) * n);
}

struct Lane {
    glm::vec3 origin, direction;
    Media media;
    std::uint32_t events;
};

template <int N>
void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context, RTCRayHitNt<N>& rays) {
    if constexpr (N == 1) rtcIntersect1(scene, context, reinterpret_cast<RTCRayHit*>(&rays));
    if constexpr (N == 4) rtcIntersect4(valid, scene, context, reinterpret_cast<RTCRayHit4*>(&rays));
    if constexpr (N == 8) rtcIntersect8(valid, scene, context, reinterpret_cast<RTCRayHit8*>(&rays));
    if constexpr (N == 16) rtcIntersect16(valid, scene, context, reinterpret_cast<RTCRayHit16*>(&rays));
}

/// Data shared by all paths of an image.
struct View {
    const Geometry& geometry;
    const ExactSettings& settings;
    FloatRays rays;
    StartMedia start_media;
    CameraRays exact_rays;  ///< for media that differ from ray to ray
    Media media;            ///< for media common to all rays
};

/// Paths of neighbouring pixels, traced in lockstep.
template <int N>
class FloatBlock {
public:
    explicit FloatBlock(const View& view) : view_(view), step_(kStep * float(view.geometry.scale())) {}

    void trace(glm::uvec2 first, std::span<glm::vec3> directions) {
        const glm::uvec2 block = block_size(N), size(view_.settings.width, view_.settings.height);
        int running = 0;
        for (int i = 0; i < N; ++i) {
            const glm::uvec2 pixel = first + glm::uvec2(unsigned(i) % block.x, unsigned(i) / block.x);
            valid_[i] = pixel.x < size.x && pixel.y < size.y ? -1 : 0;
            if (valid_[i] == 0) continue;
            start(i, pixel);
            ++running;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;  // until the first refraction
        while (running > 0) {
            intersect<N>(valid_.data(), view_.geometry.hierarchy(), &context, rays_);
            context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
            for (int i = 0; i < N; ++i) {
                if (valid_[i] == 0 || advance(i)) continue;
                const glm::uvec2 pixel = first + glm::uvec2(unsigned(i) % block.x, unsigned(i) / block.x);
                directions[std::size_t(pixel.y) * size.x + pixel.x] = lanes_[i].direction;
                valid_[i] = 0;
                --running;
            }
        }
    }

private:
    void start(int i, glm::uvec2 pixel) {
        const FloatRays::Ray ray = view_.rays.at(pixel);
        Media media = view_.media;
        if (!view_.start_media.fixed()) {
            const glm::dvec2 centre = glm::dvec2(pixel) + 0.5 + view_.settings.shift_px;
            media = media_of(view_.start_media.around(view_.exact_rays.at(centre)), view_.geometry);
        }
        lanes_[i] = {ray.origin, ray.direction, media, 0};
        aim(i, 0.0f, ray.t_max);
    }

    void aim(int i, float t_min, float t_max) {
        const Lane& lane = lanes_[i];
        RTCRayNt<N>& ray = rays_.ray;
        ray.org_x[i] = lane.origin.x;
        ray.org_y[i] = lane.origin.y;
        ray.org_z[i] = lane.origin.z;
        ray.dir_x[i] = lane.direction.x;
        ray.dir_y[i] = lane.direction.y;
        ray.dir_z[i] = lane.direction.z;
        ray.tnear[i] = t_min;
        ray.tfar[i] = t_max;
        ray.mask[i] = ~0u;
        rays_.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }

    /// Continues path i at its hit. Returns false at the end of the path.
    bool advance(int i) {
        const RTCHitNt<N>& hit = rays_.hit;
        const std::uint32_t object = hit.geomID[i], triangle = hit.primID[i];
        if (object == RTC_INVALID_GEOMETRY_ID) return false;
        const Geometry& geometry = view_.geometry;
        const SurfaceKind kind = geometry.kind(object);
        if (kind == SurfaceKind::kOpaque && !geometry.cut_out(object, triangle, double(hit.u[i]), double(hit.v[i]))) {
            return false;
        }
        Lane& lane = lanes_[i];
        const float t = rays_.ray.tfar[i];
        lane.origin += t * lane.direction;
        if (kind == SurfaceKind::kRefractive && !cross(i, lane)) return false;
        // The origin has two rounding errors: of its coordinates and of the distance to it.
        aim(i, std::max(step_, kStep * t), std::numeric_limits<float>::infinity());
        return true;
    }

    bool cross(int i, Lane& lane) {
        const RTCHitNt<N>& hit = rays_.hit;
        const Geometry& geometry = view_.geometry;
        const std::uint32_t object = hit.geomID[i];
        const glm::vec3 of_triangle(hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]);
        const float side = glm::dot(of_triangle, lane.direction);
        const bool entering = (side < 0.0f) != geometry.mirrored(object);
        Media beyond = lane.media;
        beyond.cross(std::int32_t(geometry.solid_of(geometry.shell(object, hit.primID[i]))), entering, geometry);
        const Medium *here = lane.media.medium(geometry), *there = beyond.medium(geometry);
        const bool two_media = here && there ? !(*here == *there) : here != there;
        if (!two_media) {
            lane.media = beyond;
            return true;
        }
        if (lane.events == view_.settings.max_events) return false;
        ++lane.events;
        const glm::vec3 outward =
            glm::normalize(geometry.unnormalized_normal(object, hit.primID[i], hit.u[i], hit.v[i]));
        const int channel = int(view_.settings.channel);
        lane.direction = bend(lane.direction, entering ? outward : -outward, lane.media.ior(geometry, channel),
                              beyond.ior(geometry, channel));
        // The triangle decides the side, as in exact(): the interpolated normal may contradict it.
        if ((glm::dot(of_triangle, lane.direction) < 0.0f) == (side < 0.0f)) lane.media = beyond;
        return true;
    }

    const View& view_;
    float step_;
    alignas(64) RTCRayHitNt<N> rays_{};
    alignas(64) std::array<int, N> valid_{};
    std::array<Lane, N> lanes_{};
};

template <int N>
void trace_blocks(const View& view, std::uint32_t threads, std::span<glm::vec3> directions) {
    const glm::uvec2 block = block_size(N);
    for_each_tile({view.settings.width, view.settings.height}, threads, [&](glm::uvec2 first, glm::uvec2 end) {
        FloatBlock<N> paths(view);
        for (std::uint32_t y = first.y; y < end.y; y += block.y) {
            for (std::uint32_t x = first.x; x < end.x; x += block.x) paths.trace({x, y}, directions);
        }
    });
}

}  // namespace

void trace_float(const Geometry& geometry, const Camera& camera, const ExactSettings& settings, std::uint32_t threads,
                 std::span<glm::vec3> directions) {
    check_exact_settings(settings);
    check_camera(camera);
    if (directions.size() != std::size_t(settings.width) * settings.height) {
        throw Error(
            fmt::format("a picture of {}x{} has no {} pixels", settings.width, settings.height, directions.size()));
    }
    const CameraRays exact_rays(camera, settings.width, settings.height);
    const glm::dvec2 size(settings.width, settings.height);
    View view{geometry, settings, FloatRays(camera, settings), StartMedia(geometry, exact_rays, size), exact_rays, {}};
    if (view.start_media.fixed()) {
        view.media = media_of(view.start_media.around(exact_rays.at(0.5 * size)), geometry);
    }
    switch (settings.packet) {
        case 4:
            return trace_blocks<4>(view, threads, directions);
        case 8:
            return trace_blocks<8>(view, threads, directions);
        case 16:
            return trace_blocks<16>(view, threads, directions);
        default:
            return trace_blocks<1>(view, threads, directions);
    }
}

}  // namespace pellucid::reference
