#include "bind.h"

namespace pellucid::python {
namespace {

Wrap parse_wrap(const std::string& name) {
    if (name == "repeat") return Wrap::kRepeat;
    if (name == "mirror") return Wrap::kMirror;
    if (name == "clamp") return Wrap::kClamp;
    throw unknown_name("wrap", name, std::vector<std::string_view>{"repeat", "mirror", "clamp"});
}

const char* wrap_name(Wrap wrap) {
    return wrap == Wrap::kRepeat ? "repeat" : wrap == Wrap::kMirror ? "mirror" : "clamp";
}

void wrap_property(py::class_<Texture>& texture, const char* name, Wrap Texture::*member, const char* doc) {
    texture.def_property(
        name, [member](const Texture& t) { return wrap_name(t.*member); },
        [member](Texture& t, const std::string& value) { t.*member = parse_wrap(value); }, doc);
}

void bind_texture(py::module_& module) {
    py::class_<Texture> texture(module, "Texture", "Reference from a material to an image of the scene.");
    texture.def_readwrite("image", &Texture::image, "index that Scene.add_image() returned; -1: none");
    texture.def_readwrite("texcoord_set", &Texture::texcoord_set, "0 or 1: which texture coordinates of the mesh");
    wrap_property(texture, "wrap_u", &Texture::wrap_u, "repeat, mirror or clamp: how u outside 0..1 is brought back");
    wrap_property(texture, "wrap_v", &Texture::wrap_v, "repeat, mirror or clamp: how v outside 0..1 is brought back");
    texture.def_readwrite("nearest", &Texture::nearest, "True: no interpolation between texels");
    init_by_names(texture);
}

void bind_finish(py::module_& module) {
    py::class_<Finish> finish(
        module, "Finish", "What coats an opaque surface: clear coat, sheen, specular factors, thin film, anisotropy.");
    finish.def_readwrite("clearcoat", &Finish::clearcoat, "share of the surface with a coat of index 1.5, 0..1");
    finish.def_readwrite("clearcoat_roughness", &Finish::clearcoat_roughness, "perceptual roughness, 0..1");
    vector_property(finish, "sheen_color", &Finish::sheen_color, "linear RGB, 0..1");
    finish.def_readwrite("sheen_roughness", &Finish::sheen_roughness, "perceptual roughness, 0..1");
    finish.def_readwrite("specular", &Finish::specular, "strength of what a dielectric reflects, 0..1");
    vector_property(finish, "specular_color", &Finish::specular_color, "linear RGB, >= 0; what it reflects head-on");
    finish.def_readwrite("iridescence", &Finish::iridescence, "share of the surface under a thin film, 0..1");
    finish.def_readwrite("film_ior", &Finish::film_ior, "index of refraction of the film, >= 1");
    finish.def_readwrite("film_thinnest_nm", &Finish::film_thinnest_nm, "thickness of the film in nm, >= 0");
    finish.def_readwrite("film_thickest_nm", &Finish::film_thickest_nm, "thickness of the film in nm, >= 0");
    finish.def_readwrite("anisotropy", &Finish::anisotropy, "stretch of the reflection, 0..1");
    finish.def_readwrite("anisotropy_rotation", &Finish::anisotropy_rotation, "radians, counter-clockwise");
    init_by_names(finish);
}

void add_textures(py::class_<Material>& material) {
    const auto add = [&](const char* name, Texture Material::*member, const char* doc) {
        material.def_readwrite(name, member, doc);
    };
    add("base_color_texture", &Material::base_color_texture, "multiplies base_color; its image is sRGB-encoded");
    add("metallic_roughness_texture", &Material::metallic_roughness_texture,
        "green multiplies roughness, blue metallic (linear)");
    add("emission_texture", &Material::emission_texture, "multiplies emission; its image is sRGB-encoded");
    add("transmission_texture", &Material::transmission_texture, "red multiplies transmission (linear)");
    add("normal_texture", &Material::normal_texture, "red, green, blue 0..1: direction from -1..1");
    add("occlusion_texture", &Material::occlusion_texture, "red: share of the environment's light that arrives");
}

}  // namespace

void bind_materials(py::module_& module) {
    bind_texture(module);
    bind_finish(module);
    py::class_<Material> material(module, "Material",
                                  "Material of glTF with extensions. Refracting glass has transmission > 0 and "
                                  "thickness > 0; with thickness 0 it is a thin wall, which does not bend light.");
    material.def_readwrite("name", &Material::name, "name for messages");
    vector_property(material, "base_color", &Material::base_color,
                    "linear RGB and alpha, 0..1; tints transmitted light");
    material.def_readwrite("metallic", &Material::metallic, "0..1");
    material.def_readwrite("roughness", &Material::roughness, "perceptual, 0..1; 0: smooth");
    vector_property(material, "emission", &Material::emission, "linear radiance, W/(m2 sr), RGB, >= 0");
    material.def_readwrite("alpha_cutoff", &Material::alpha_cutoff, "alpha below this is a hole; 0: no holes");
    material.def_readwrite("alpha_is_coverage", &Material::alpha_is_coverage, "alpha is the covered share, 0..1");
    material.def_readwrite("unlit", &Material::unlit, "shows base_color itself");
    material.def_readwrite("double_sided", &Material::double_sided,
                           "False: opaque surfaces are seen from outside only");
    material.def_readwrite("transmission", &Material::transmission, "share of light that enters, 0..1; 0: opaque");
    material.def_readwrite("ior", &Material::ior, "index of refraction at the d line, >= 1");
    material.def_readwrite("dispersion", &Material::dispersion, "20 / Abbe number; 0: none");
    material.def_readwrite("thickness", &Material::thickness, "> 0: solid glass that bends light; 0: thin wall");
    vector_property(material, "attenuation_color", &Material::attenuation_color,
                    "RGB 0..1: what is left of white light after attenuation_distance");
    material.def_readwrite("attenuation_distance", &Material::attenuation_distance, "m, > 0; infinite: clear");
    material.def_readwrite("diffuse_transmission", &Material::diffuse_transmission,
                           "share of scattered light that leaves on the other side, 0..1");
    vector_property(material, "diffuse_transmission_color", &Material::diffuse_transmission_color, "linear RGB, 0..1");
    material.def_readwrite("normal_scale", &Material::normal_scale, "factor of the normal texture's x and y");
    material.def_readwrite("occlusion_strength", &Material::occlusion_strength, "0..1; 0: no effect");
    material.def_readwrite("finish", &Material::finish, "coating of an opaque surface");
    add_textures(material);
    material.def_property_readonly("refractive", &Material::refractive, "True for solid glass, which bends light");
    material.def_property_readonly(
        "sigma_a", [](const Material& m) { return from_vector(m.sigma_a()); }, "absorption, RGB, 1/m");
    material.def_static(
        "glass",
        [](float ior, const py::object& attenuation_color, float attenuation_distance, float roughness) {
            Material glass;
            glass.name = "glass";
            glass.transmission = 1.0f;
            glass.thickness = 1.0f;
            glass.ior = ior;
            glass.attenuation_color = to_vector<glm::vec3>(attenuation_color, "attenuation_color");
            glass.attenuation_distance = attenuation_distance;
            glass.roughness = roughness;
            return glass;
        },
        py::arg("ior") = 1.5f, py::arg("attenuation_color") = py::make_tuple(1.0, 1.0, 1.0),
        py::arg("attenuation_distance") = std::numeric_limits<float>::infinity(), py::arg("roughness") = 0.0f,
        "Solid glass of index `ior` (>= 1). attenuation_color (RGB 0..1) is left of white light after "
        "attenuation_distance (m).");
    init_by_names(material);
}

}  // namespace pellucid::python
