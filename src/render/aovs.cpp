#include "render/aovs.h"

#include <pellucid/error.h>
#include <pellucid/names.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::array kAovs = {
    AovInfo{"exit-direction", 3,
            "unit world direction in which the path leaves the glass; the view ray where there is none"},
    AovInfo{"exit-position", 3,
            "position of the path's last interface, m, without the scene's origin; the eye where there is no glass"},
    AovInfo{"exit-object", 1, "index of the opaque object that the path ends on; -1: it leaves into the environment"},
    AovInfo{"path-length", 1, "length of the path inside glass, m"},
    AovInfo{"events", 2, "interface events on the path; total internal reflections among them"},
    AovInfo{"status", 1, "0 ok, 1 missing_layer, 2 left_screen, 3 step_limit, 4 event_limit"},
    AovInfo{"layers", 1, "glass surfaces recorded along the view ray"},
    AovInfo{"depth", 1,
            "depth of the first glass surface along -Z of the view, m; 0 where there is none; depth-2: of the second"},
    AovInfo{"normal", 3,
            "outward world normal of the first glass surface; 0 where there is none; normal-2: of the second"},
    AovInfo{"object", 1, "index of the first glass surface's object; -1 where there is none; object-2: of the second"},
    AovInfo{"back-depth", 1, "depth of the last recorded surface that leads out of glass, m; 0 where there is none"},
    AovInfo{"back-normal", 3, "outward world normal of that surface; 0 where there is none"},
    AovInfo{"emitted", 3, "light that is seen directly, or reflected and refracted by smooth surfaces alone"},
    AovInfo{"direct", 3, "light that meets one surface that is not smooth, and no other before it"},
    AovInfo{"caustic", 3, "light that smooth surfaces throw onto one that is not smooth"},
    AovInfo{"indirect", 3, "light that meets two or more surfaces that are not smooth"},
};

template <class T>
std::vector<T> read(const Device& device, const GpuImage& image, std::uint32_t layer = 0) {
    const std::vector<std::byte> bytes = download(device, image, layer);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

/// Twin of unpack_unit_vector() in octahedral.glsl.
glm::vec3 unpack_unit_vector(std::uint32_t packed) {
    const auto snorm = [](std::uint32_t bits) {
        return std::max(float(std::int16_t(std::uint16_t(bits))) / 32767.0f, -1.0f);
    };
    const glm::vec2 p(snorm(packed & 0xffffu), snorm(packed >> 16));
    glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0f) {
        n.x = (1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f);
        n.y = (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f);
    }
    return glm::normalize(n);
}

Image vector_image(vk::Extent2D extent, const std::vector<glm::vec4>& values) {
    Image image(int(extent.width), int(extent.height), 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < 3; ++c) image.pixels[3 * i + std::size_t(c)] = values[i][c];
    }
    return image;
}

template <class Value>
Image scalar_image(vk::Extent2D extent, Value value) {
    Image image(int(extent.width), int(extent.height), 1);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = value(i);
    return image;
}

Image layer_count_image(const Device& device, const Layers& layers) {
    Image image(int(layers.depth.extent().width), int(layers.depth.extent().height), 1);
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const auto depth = read<float>(device, layers.depth, layer);
        for (std::size_t i = 0; i < depth.size(); ++i)
            image.pixels[i] += depth[i] < float(PELLUCID_EMPTY_DEPTH) ? 1.0f : 0.0f;
    }
    return image;
}

/// Twin of find_object() in objects.glsl: the last object that starts at or before the triangle.
float object_of_triangle(const std::vector<std::uint32_t>& first_triangles, std::uint32_t word) {
    if (word == PELLUCID_NO_TRIANGLE) return -1.0f;
    const auto after = std::upper_bound(first_triangles.begin(), first_triangles.end(), word & ~PELLUCID_BACK_FACE);
    return float(after - first_triangles.begin() - 1);
}

Image surface_aov(const Device& device, const NamedAov& aov, const Layers& layers,
                  const std::vector<std::uint32_t>& first_triangles) {
    const vk::Extent2D extent = layers.depth.extent();
    if (aov.info->name == "depth") {
        const auto depth = read<float>(device, layers.depth, aov.layer);
        return scalar_image(extent,
                            [&](std::size_t i) { return depth[i] < float(PELLUCID_EMPTY_DEPTH) ? depth[i] : 0.0f; });
    }
    const auto triangles = read<std::uint32_t>(device, layers.triangle, aov.layer);
    if (aov.info->name == "object") {
        return scalar_image(extent, [&](std::size_t i) { return object_of_triangle(first_triangles, triangles[i]); });
    }
    const auto packed = read<std::uint32_t>(device, layers.normal, aov.layer);
    std::vector<glm::vec4> normals(packed.size(), glm::vec4(0.0f));
    for (std::size_t i = 0; i < packed.size(); ++i) {
        if (triangles[i] != PELLUCID_NO_TRIANGLE) normals[i] = glm::vec4(unpack_unit_vector(packed[i]), 0.0f);
    }
    return vector_image(extent, normals);
}

/// `value` of the last layer in which a pixel's view ray leaves glass. Layers are read one at a time.
template <class T, class Value>
void for_last_back_face(const Device& device, const Layers& layers, const GpuImage& image, Value value) {
    for (std::uint32_t layer = 0; layer < layers.count; ++layer) {
        const auto triangles = read<std::uint32_t>(device, layers.triangle, layer);
        const auto texels = read<T>(device, image, layer);
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (triangles[i] != PELLUCID_NO_TRIANGLE && (triangles[i] & PELLUCID_BACK_FACE) != 0) value(i, texels[i]);
        }
    }
}

Image back_depth_image(const Device& device, const Layers& layers) {
    Image image(int(layers.depth.extent().width), int(layers.depth.extent().height), 1);
    for_last_back_face<float>(device, layers, layers.depth,
                              [&](std::size_t i, float depth) { image.pixels[i] = depth; });
    return image;
}

Image back_normal_image(const Device& device, const Layers& layers) {
    const vk::Extent2D extent = layers.depth.extent();
    std::vector<glm::vec4> normals(std::size_t(extent.width) * extent.height, glm::vec4(0.0f));
    for_last_back_face<std::uint32_t>(device, layers, layers.normal, [&](std::size_t i, std::uint32_t packed) {
        normals[i] = glm::vec4(unpack_unit_vector(packed), 0.0f);
    });
    return vector_image(extent, normals);
}

/// Twin of camera_ray() in camera.glsl, in the world: the view ray through the centre of a pixel.
struct ViewRay {
    glm::vec3 origin, direction;
};
ViewRay view_ray(const gpu::FrameConstants& view, std::uint32_t x, std::uint32_t y) {
    const glm::vec2 pixel(float(view.first_x + x) + 0.5f, float(view.first_y + y) + 0.5f);
    const glm::vec2 film(view.film.x + pixel.x * view.film.z, view.film.y - pixel.y * view.film.w);
    const bool orthographic = view.orthographic != 0;
    const glm::vec3 origin = orthographic ? glm::vec3(film, 0.0f) : glm::vec3(0.0f);
    const glm::vec3 direction = orthographic ? glm::vec3(0.0f, 0.0f, -1.0f) : glm::normalize(glm::vec3(film, -1.0f));
    return {glm::vec3(view.world_from_view * glm::vec4(origin, 1.0f)),
            glm::normalize(glm::mat3(view.world_from_view) * direction)};
}

/// A finished refraction on the host: where there is no glass, the view ray.
class HostRefraction {
public:
    HostRefraction(const Device& device, const Refraction& refraction, const gpu::FrameConstants& view)
        : device_(device), refraction_(refraction), view_(view) {
        for (const std::uint32_t word : read<std::uint32_t>(device, refraction.events)) {
            events_.push_back(unpack_events(word));
        }
    }
    const std::vector<PathEvents>& events() const { return events_; }
    std::vector<glm::vec4> exit_directions() const {
        return filled(refraction_.exit_direction, [](const ViewRay& ray) { return glm::vec4(ray.direction, 0.0f); });
    }
    std::vector<glm::vec4> exit_positions() const {
        return filled(refraction_.exit_position,
                      [](const ViewRay& ray) { return glm::vec4(ray.origin, kEndsInEnvironment); });
    }
    std::vector<glm::vec4> transmittances() const {
        return filled(refraction_.transmittance, [](const ViewRay&) { return glm::vec4(1.0f); });
    }

private:
    template <class Fill>
    std::vector<glm::vec4> filled(const GpuImage& image, Fill fill) const {
        auto texels = read<glm::vec4>(device_, image);
        if (refraction_.everywhere) return texels;
        const std::uint32_t width = image.extent().width;
        for (std::size_t i = 0; i < texels.size(); ++i) {
            if (events_[i].interfaces == 0) {
                texels[i] = fill(view_ray(view_, std::uint32_t(i % width), std::uint32_t(i / width)));
            }
        }
        return texels;
    }

    const Device& device_;
    const Refraction& refraction_;
    const gpu::FrameConstants& view_;
    std::vector<PathEvents> events_;
};

Image make_aov(const Device& device, const NamedAov& aov, const Layers& layers, const HostRefraction& refraction,
               const std::vector<std::uint32_t>& first_triangles) {
    const std::string_view name = aov.info->name;
    const vk::Extent2D extent = layers.depth.extent();
    const std::vector<PathEvents>& events = refraction.events();
    if (name == "exit-direction") return vector_image(extent, refraction.exit_directions());
    if (name == "exit-position") return vector_image(extent, refraction.exit_positions());
    if (name == "exit-object") {
        const auto positions = refraction.exit_positions();
        return scalar_image(extent, [&](std::size_t i) { return positions[i].w; });
    }
    if (name == "path-length") {
        const auto directions = refraction.exit_directions();
        return scalar_image(extent, [&](std::size_t i) { return directions[i].w; });
    }
    if (name == "events") {
        Image image(int(extent.width), int(extent.height), 2);
        for (std::size_t i = 0; i < events.size(); ++i) {
            image.pixels[2 * i] = float(events[i].interfaces);
            image.pixels[2 * i + 1] = float(events[i].reflections);
        }
        return image;
    }
    if (name == "status") return scalar_image(extent, [&](std::size_t i) { return float(events[i].status); });
    if (name == "layers") return layer_count_image(device, layers);
    if (name == "back-depth") return back_depth_image(device, layers);
    if (name == "back-normal") return back_normal_image(device, layers);
    return surface_aov(device, aov, layers, first_triangles);
}

std::vector<RefractedPath> read_paths(const HostRefraction& refraction) {
    const std::vector<PathEvents>& events = refraction.events();
    std::vector<RefractedPath> paths(events.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
        paths[i].events = std::uint16_t(events[i].interfaces);
        paths[i].reflections = std::uint16_t(events[i].reflections);
        paths[i].status = events[i].status;
        paths[i].side_conflict = events[i].side_conflict;
    }
    // One image at a time: at 4K each is 133 MB.
    const auto for_each_texel = [&](const std::vector<glm::vec4>& texels, auto&& take) {
        for (std::size_t i = 0; i < paths.size(); ++i) take(paths[i], texels[i]);
    };
    for_each_texel(refraction.exit_directions(), [](RefractedPath& path, const glm::vec4& texel) {
        path.direction = texel;
        path.length_inside = texel.w;
    });
    for_each_texel(refraction.exit_positions(), [](RefractedPath& path, const glm::vec4& texel) {
        path.position = texel;
        path.object = std::int32_t(texel.w);
    });
    for_each_texel(refraction.transmittances(),
                   [](RefractedPath& path, const glm::vec4& texel) { path.transmittance = texel; });
    return paths;
}

}  // namespace

std::span<const AovInfo> aov_infos() { return kAovs; }

NamedAov parse_aov(const std::string& name) {
    std::vector<std::string_view> known;
    for (const AovInfo& aov : kAovs) {
        if (aov.name == name) return {&aov};
        known.push_back(aov.name);
    }
    for (const AovInfo& aov : kAovs) {
        const bool of_surface = aov.name == "depth" || aov.name == "normal" || aov.name == "object";
        if (!of_surface || !name.starts_with(std::string(aov.name) + "-")) continue;
        const std::string number = name.substr(aov.name.size() + 1);
        std::uint32_t surface = 0;
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), surface);
        if (error == std::errc() && end == number.data() + number.size() && number.front() != '0' && surface >= 2)
            return {&aov, surface - 1};
    }
    throw unknown_name("AOV", name, known);
}

void check_aov_layers(const std::vector<std::string>& names, std::uint32_t layers, std::string_view technique) {
    for (const std::string& name : names) {
        if (parse_aov(name).layer < layers) continue;
        throw Error(fmt::format("AOV '{}': {} records {} surface{} of a pixel, as its parameter layers says", name,
                                technique, layers, layers == 1 ? "" : "s"));
    }
}

bool is_light_part(const std::string& name) {
    return std::find(kLightParts.begin(), kLightParts.end(), name) != kLightParts.end();
}

void read_back(const Device& device, const FrameImages& images, const gpu::FrameConstants& view,
               const std::vector<std::uint32_t>& first_triangles, const RenderSettings& settings,
               RenderResult& result) {
    const HostRefraction refraction(device, images.refraction, view);
    for (const PathEvents& events : refraction.events()) {
        if (events.interfaces == 0) continue;
        ++result.covered;
        ++result.status.at(std::size_t(events.status));
        result.side_conflicts += events.side_conflict ? 1 : 0;
    }
    for (const std::string& name : settings.aovs) {
        if (is_light_part(name)) continue;
        result.aovs[name] = make_aov(device, parse_aov(name), images.layers, refraction, first_triangles);
    }
    if (settings.paths) result.paths = read_paths(refraction);
}

}  // namespace pellucid
