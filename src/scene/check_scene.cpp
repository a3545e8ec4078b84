#include "scene/check_scene.h"

#include "core/math.h"
#include "scene/material_textures.h"

#include <pellucid/error.h>
#include <pellucid/mesh.h>

#include <fmt/format.h>

#include <cmath>

namespace pellucid {
namespace {

void require(bool holds, const std::string& what, const char* promise) {
    if (!holds) throw Error(fmt::format("{}: {}", what, promise));
}

template <class Vector>
bool finite(const Vector& v) {
    for (int i = 0; i < v.length(); ++i) {
        if (!std::isfinite(v[i])) return false;
    }
    return true;
}

bool finite(const glm::mat4& m) { return finite(m[0]) && finite(m[1]) && finite(m[2]) && finite(m[3]); }

template <class Vector>
bool all_finite(const std::vector<Vector>& values) {
    for (const Vector& value : values) {
        if (!finite(value)) return false;
    }
    return true;
}

bool holds_its_pixels(const Image& image) {
    return image.width > 0 && image.height > 0 && image.channels > 0 && image.channels <= 4 &&
           image.pixels.size() == std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
}

bool unit_range(float value) { return value >= 0.0f && value <= 1.0f; }

void check_finish(const Finish& f, const std::string& what) {
    for (const float share : {f.clearcoat, f.clearcoat_roughness, f.sheen_roughness, f.specular, f.iridescence,
                              f.anisotropy, f.sheen_color.r, f.sheen_color.g, f.sheen_color.b})
        require(unit_range(share), what, "the factors of its finish must be within 0..1");
    require(finite(f.specular_color) && glm::all(glm::greaterThanEqual(f.specular_color, glm::vec3(0.0f))), what,
            "the specular colour must be finite and not negative");
    require(f.film_ior >= 1.0f && std::isfinite(f.film_ior) && f.film_thinnest_nm >= 0.0f &&
                std::isfinite(f.film_thinnest_nm) && f.film_thickest_nm >= 0.0f && std::isfinite(f.film_thickest_nm),
            what, "the index of its film must be at least 1, its thickness finite and not negative");
    require(std::isfinite(f.anisotropy_rotation) && std::isfinite(f.clearcoat_normal_scale), what,
            "a factor of its finish is not finite");
}

void check_material(const Material& m, const std::string& what, std::size_t images) {
    check_finish(m.finish, what);
    require(std::isfinite(m.normal_scale) && unit_range(m.occlusion_strength), what,
            "the scale of normals must be finite, the strength of occlusion within 0..1");
    for (const Texture* texture : textures_of(m)) {
        require(texture->image < int(images), what, "a texture refers to an image that is not there");
        require(texture->texcoord_set == 0 || texture->texcoord_set == 1, what, "texture coordinate sets are 0 and 1");
    }
    require(finite(m.base_color) && finite(m.emission) && std::isfinite(m.transmission) && std::isfinite(m.metallic) &&
                std::isfinite(m.roughness),
            what, "a factor is not finite");
    require(m.diffuse_transmission >= 0.0f && m.diffuse_transmission <= 1.0f && finite(m.diffuse_transmission_color),
            what, "the diffuse transmission must be within 0..1, its colour finite");
    require(m.ior >= 1.0f && std::isfinite(m.ior), what, "the index of refraction must be at least 1");
    require(m.dispersion >= 0.0f && std::isfinite(m.dispersion), what,
            "the dispersion must be finite and not negative");
    require(m.attenuation_distance > 0.0f, what, "the attenuation distance must be above 0");
    const glm::vec3 c = m.attenuation_color;
    require(finite(c) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f, what,
            "the attenuation colour must not be negative");
}

void check_light(const Light& light, const std::string& what) {
    require(finite(light.intensity) && glm::all(glm::greaterThanEqual(light.intensity, glm::vec3(0.0f))), what,
            "the intensity must be finite and not negative");
    require(finite(light.position), what, "the position is not finite");
    require(std::abs(glm::length(light.direction) - 1.0f) < 1e-3f, what, "the direction must be of unit length");
    require(light.range > 0.0f, what, "the range must be above 0");
    require(light.inner_cone_angle >= 0.0f && light.inner_cone_angle < light.outer_cone_angle &&
                light.outer_cone_angle <= kPi,
            what, "the cone angles must be 0 <= inner < outer <= pi");
    require(light.radius >= 0.0f && std::isfinite(light.radius), what, "the radius must be finite and not negative");
    require(light.angular_diameter >= 0.0f && light.angular_diameter < kPi, what,
            "the angular diameter must be 0 to pi, without pi");
}

}  // namespace

void check_mesh(const Mesh& mesh, const std::string& what) {
    const std::size_t count = mesh.positions.size();
    require(all_finite(mesh.positions), what, "a position is not finite");
    require(mesh.normals.size() == count && all_finite(mesh.normals), what, "needs one finite normal per position");
    for (const auto& set : mesh.texcoords) {
        require(set.empty() || (set.size() == count && all_finite(set)), what,
                "texture coordinates must be none, or one per position and finite");
    }
    require(mesh.colors.empty() || (mesh.colors.size() == count && all_finite(mesh.colors)), what,
            "colours must be none, or one per position and finite");
    require(mesh.tangents.empty() || (mesh.tangents.size() == count && all_finite(mesh.tangents)), what,
            "tangents must be none, or one per position and finite");
    for (const glm::uvec3& t : mesh.triangles) {
        require(t.x < count && t.y < count && t.z < count, what, "a triangle refers to a vertex that is not there");
    }
}

bool is_similarity(const glm::mat4& transform) {
    if (!finite(transform)) return false;
    const glm::mat3 m(transform);
    const float scale = glm::length(m[0]);
    constexpr float kRounding = 1e-4f;
    const auto same = [&](const glm::vec3& a, const glm::vec3& b, float wanted) {
        return std::abs(glm::dot(a, b) - wanted * scale * scale) <= kRounding * scale * scale;
    };
    return scale > 0.0f && same(m[1], m[1], 1.0f) && same(m[2], m[2], 1.0f) && same(m[0], m[1], 0.0f) &&
           same(m[0], m[2], 0.0f) && same(m[1], m[2], 0.0f);
}

void check_materials(const Scene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        check_material(scene.materials[i], fmt::format("material {} '{}'", i, scene.materials[i].name),
                       scene.images.size());
    }
}

void check_objects(const Scene& scene) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const std::string what = fmt::format("object {} '{}'", i, object.name);
        require(object.mesh >= 0 && object.mesh < int(scene.meshes.size()), what, "there is no such mesh");
        require(object.material >= 0 && object.material < int(scene.materials.size()), what,
                "there is no such material");
        const glm::mat4& m = object.world_from_object;
        require(finite(m) && glm::determinant(glm::dmat3(m)) != 0.0, what,
                "its transform is not finite and invertible");
    }
}

void check_scene(const Scene& scene) {
    require(scene.image_names.size() == scene.images.size(), "scene", "needs one name per image");
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        require(holds_its_pixels(scene.images[i]), fmt::format("image {}", i), "its pixels do not fit its size");
    }
    check_materials(scene);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        check_mesh(scene.meshes[i], fmt::format("mesh {} '{}'", i, scene.meshes[i].name));
    }
    check_objects(scene);
    for (std::size_t i = 0; i < scene.volumes.size(); ++i) {
        require(scene.volumes[i] != nullptr, fmt::format("volume {}", i), "there is none");
        check_volume(*scene.volumes[i]);
    }
    for (std::size_t i = 0; i < scene.volume_objects.size(); ++i) {
        const VolumeObject& object = scene.volume_objects[i];
        const std::string what = fmt::format("placement {} '{}' of a volume", i, object.name);
        require(object.volume >= 0 && object.volume < int(scene.volumes.size()), what, "there is no such volume");
        require(is_similarity(object.world_from_volume), what, "its transform does not scale alike in all directions");
        for (const int stood_for : object.objects)
            require(stood_for >= 0 && stood_for < int(scene.objects.size()), what,
                    "an object that it stands for is none");
    }
    check_lights(scene.lights);
}

void check_lights(std::span<const Light> lights) {
    for (std::size_t i = 0; i < lights.size(); ++i)
        check_light(lights[i], fmt::format("light {} '{}'", i, lights[i].name));
}

void check_camera(const Camera& camera) {
    const std::string what = camera.name.empty() ? "camera" : fmt::format("camera '{}'", camera.name);
    require(finite(camera.world_from_view) && glm::determinant(glm::mat3(camera.world_from_view)) != 0.0f, what,
            "its transform is not finite and invertible");
    if (camera.orthographic) {
        require(camera.vertical_extent > 0.0f && std::isfinite(camera.vertical_extent), what,
                "an orthographic camera needs a vertical extent above 0");
    } else {
        require(camera.vertical_fov > 0.0f && camera.vertical_fov < kPi, what,
                "the field of view must be 0 to pi, both excluded");
    }
    require(camera.near_plane >= 0.0f && std::isfinite(camera.near_plane), what,
            "the near plane must be finite, at 0 or beyond");
    require(camera.far_plane == 0.0f || (camera.far_plane > camera.near_plane && std::isfinite(camera.far_plane)), what,
            "the far plane must lie beyond the near plane");
}

void check_environment(const Environment& environment) {
    if (environment.kind == Environment::Kind::kMap) {
        require(holds_its_pixels(environment.map) && environment.map.channels == 3, "environment",
                "the map needs 3 channels");
    }
    require(finite(environment.uniform_radiance), "environment", "the uniform radiance is not finite");
    require(std::isfinite(environment.rotation), "environment", "the rotation is not finite");
    require(environment.intensity >= 0.0f && std::isfinite(environment.intensity), "environment",
            "the intensity must be finite, at 0 or above");
}

}  // namespace pellucid
