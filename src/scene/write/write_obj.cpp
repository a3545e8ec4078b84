// Wavefront OBJ and MTL, with Pr, Pm, Ke and norm as mtl_file.cpp reads them.
#include "core/fail.h"
#include "scene/write/png_bytes.h"
#include "scene/write/scene_writers.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

namespace pellucid {
namespace {

class ObjWriter {
public:
    ObjWriter(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out)
        : file_(file), scene_(scene), left_out_(left_out) {}

    void write() {
        std::filesystem::path library = file_;
        library.replace_extension(".mtl");
        check_writable(library);
        add(obj_, "# Pellucid\nmtllib {}\n", library.filename().string());
        for (const Object& object : scene_.objects) {
            const std::string name = unique_name(object.name);
            add(obj_, "o {}\nusemtl {}\n", name, name);
            add_mesh(object);
            add_material(name, scene_.materials[std::size_t(object.material)]);
        }
        report_left_out();
        write_text_file(library, mtl_);
        write_text_file(file_, obj_);
    }

private:
    template <class... Arguments>
    static void add(std::string& to, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(to), format, std::forward<Arguments>(arguments)...);
    }

    /// Faces of one material are one object to those who read the file.
    std::string unique_name(const std::string& object) {
        const std::string base = object.empty() ? "object" : one_line(object);
        std::string name = base;
        for (int n = 2; !names_.insert(name).second; ++n) name = fmt::format("{} {}", base, n);
        return name;
    }

    void add_mesh(const Object& object) {
        const Mesh& mesh = scene_.meshes[std::size_t(object.mesh)];
        const glm::dmat4 world(object.world_from_object);
        const glm::dmat3 turn = glm::transpose(glm::inverse(glm::dmat3(world)));
        const bool placed = object.world_from_object != glm::mat4(1.0f);
        for (const glm::vec3& position : mesh.positions) {
            const glm::dvec3 p = glm::dvec3(world * glm::dvec4(position, 1.0));
            // Floats in their shortest form, unless the origin needs more digits.
            if (scene_.origin == glm::dvec3(0.0))
                add(obj_, "v {} {} {}\n", float(p.x), float(p.y), float(p.z));
            else
                add(obj_, "v {:.15g} {:.15g} {:.15g}\n", p.x + scene_.origin.x, p.y + scene_.origin.y,
                    p.z + scene_.origin.z);
        }
        for (const glm::vec3& normal : mesh.normals) {
            const glm::vec3 n = placed ? glm::vec3(glm::normalize(turn * glm::dvec3(normal))) : normal;
            add(obj_, "vn {} {} {}\n", n.x, n.y, n.z);
        }
        const bool textured = !mesh.texcoords[0].empty();
        for (const glm::vec2& t : mesh.texcoords[0]) add(obj_, "vt {} {}\n", t.x, 1.0f - t.y);
        const bool mirrors = glm::determinant(glm::dmat3(world)) < 0.0;
        for (const glm::uvec3& triangle : mesh.triangles) {
            obj_ += "f";
            for (const int k : mirrors ? std::array{0, 2, 1} : std::array{0, 1, 2}) {
                const std::size_t corner = triangle[k] + 1;
                if (textured)
                    add(obj_, " {}/{}/{}", vertices_ + corner, texcoords_ + corner, vertices_ + corner);
                else
                    add(obj_, " {}//{}", vertices_ + corner, vertices_ + corner);
            }
            obj_ += "\n";
        }
        vertices_ += mesh.positions.size();
        texcoords_ += mesh.texcoords[0].size();
        if (!mesh.colors.empty()) lost_.insert("colours of vertices");
    }

    void add_material(const std::string& name, const Material& m) {
        const glm::vec3 color(m.base_color);
        add(mtl_, "newmtl {}\nKd {} {} {}\nPr {}\n", name, color.r, color.g, color.b, m.roughness);
        if (m.transmissive()) {
            add(mtl_, "illum 7\nNi {}\nTf {} {} {}\n", m.ior, color.r, color.g, color.b);
            if (m.base_color_texture.image >= 0) lost_.insert("textures of glass");
            if (m.transmission < 1.0f) lost_.insert("transmission below 1");
            if (std::isfinite(m.attenuation_distance)) lost_.insert("attenuation");
            if (m.dispersion > 0.0f) lost_.insert("dispersion");
        } else {
            add(mtl_, "illum 2\nPm {}\n", m.metallic);
            if (m.alpha_is_coverage && m.base_color.a < 1.0f) add(mtl_, "d {}\n", m.base_color.a);
            add_texture("map_Kd", m.base_color_texture);
            if (m.alpha_cutoff > 0.0f) add_texture("map_d", m.base_color_texture);
            add_texture("norm", m.normal_texture);
            if (m.alpha_is_coverage && m.base_color_texture.image >= 0) lost_.insert("coverage by a texture");
            if (m.metallic_roughness_texture.image >= 0) lost_.insert("textures of metal and roughness");
            if (m.translucent()) lost_.insert("translucency");
            if (m.unlit) lost_.insert("surfaces without light");
            if (m.single_sided()) lost_.insert("surfaces with one side");
            if (!m.finish.plain()) lost_.insert("finishes");
        }
        if (m.emission == glm::vec3(0.0f)) return;
        add(mtl_, "Ke {} {} {}\n", m.emission.r, m.emission.g, m.emission.b);
        add_texture("map_Ke", m.emission_texture);
    }

    void add_texture(const char* keyword, const Texture& texture) {
        if (texture.image < 0) return;
        const glm::mat3& m = texture.uv_from_texcoord;
        if (texture.texcoord_set != 0 || m[0][1] != 0.0f || m[1][0] != 0.0f) {
            lost_.insert("textures that are turned or have coordinates of their own");
            return;
        }
        mtl_ += keyword;
        if (texture.wrap_u == Wrap::kClamp) mtl_ += " -clamp on";
        if (m != glm::mat3(1.0f))
            add(mtl_, " -s {} {} 1 -o {} {} 0", m[0][0], m[1][1], m[2][0], 1.0f - m[1][1] - m[2][1]);
        add(mtl_, " {}\n", image_file(texture.image));
    }

    /// Writes an image on its first use.
    const std::string& image_file(int index) {
        const auto [found, is_new] = images_.try_emplace(index);
        if (!is_new) return found->second;
        const std::filesystem::path file =
            file_.parent_path() / fmt::format("{}-{}.png", file_.stem().string(), images_.size() - 1);
        const Image& image = scene_.images[std::size_t(index)];
        if (!is_exact_as_png(image)) lost_.insert("values of images beyond 8 bits");
        write_image(file, image);
        return found->second = file.filename().string();
    }

    void report_left_out() {
        if (!scene_.lights.empty()) lost_.insert("lights");
        if (!scene_.cameras.empty()) lost_.insert("cameras");
        for (const std::string& what : lost_) left_out_.push_back(what + " left out; OBJ has no word for it");
    }

    const std::filesystem::path& file_;
    const Scene& scene_;
    std::vector<std::string>& left_out_;
    std::string obj_, mtl_;
    std::size_t vertices_ = 0, texcoords_ = 0;  ///< so far
    std::set<std::string> names_, lost_;
    std::map<int, std::string> images_;  ///< files, by index into Scene::images
};

}  // namespace

void write_obj(const std::filesystem::path& file, const Scene& scene, std::vector<std::string>& left_out) {
    ObjWriter(file, scene, left_out).write();
}

}  // namespace pellucid
