#include "bind.h"

#include <pybind11/stl/filesystem.h>

#include <array>

namespace pellucid::python {
namespace {

struct ScalarField {
    const char* name;
    std::vector<float> Volume::*member;
    const char* doc;
};
struct ColorField {
    const char* name;
    std::vector<glm::vec3> Volume::*member;
    const char* doc;
};

constexpr std::array kScalars = {
    ScalarField{"n", &Volume::n, "index of refraction, > 0, float32, shape (z, y, x)"},
    ScalarField{"n_red", &Volume::n_red, "index for red in dispersive media, shape (z, y, x)"},
    ScalarField{"n_blue", &Volume::n_blue, "index for blue in dispersive media, shape (z, y, x)"},
    ScalarField{"g", &Volume::g, "mean cosine of scattering, -1..1, shape (z, y, x)"},
    ScalarField{"boundary", &Volume::boundary, "reflecting surfaces, 0..1, shape (z, y, x)"},
};
constexpr std::array kColors = {
    ColorField{"sigma_a", &Volume::sigma_a, "absorption, 1/m, shape (z, y, x, 3)"},
    ColorField{"sigma_s", &Volume::sigma_s, "scattering, 1/m, shape (z, y, x, 3)"},
    ColorField{"emission", &Volume::emission, "radiance added per metre, W/(m3 sr), shape (z, y, x, 3)"},
};

py::object grid_array(const Volume& volume, const float* values, std::size_t count, bool color) {
    if (count == 0) return py::none();
    std::vector<py::ssize_t> shape{volume.size.z, volume.size.y, volume.size.x};
    if (color) shape.push_back(3);
    return py::array_t<float>(shape, values);
}

Volume make_from_arrays(float voxel, const py::object& low, const std::string& name, const py::kwargs& fields) {
    Volume volume;
    volume.name = name;
    volume.voxel = voxel;
    volume.low = to_vector<glm::vec3>(low, "low");
    std::vector<std::string_view> known;
    for (const ScalarField& field : kScalars) known.push_back(field.name);
    for (const ColorField& field : kColors) known.push_back(field.name);
    for (const auto& [key, value] : fields) {
        const std::string given = py::str(key);
        if (std::find(known.begin(), known.end(), given) == known.end())
            throw unknown_name("field of a volume", given, known);
        for (const ScalarField& field : kScalars)
            if (given == field.name) volume.*field.member = to_grid(value, given, volume.size, 1);
        for (const ColorField& field : kColors) {
            if (given != field.name) continue;
            const std::vector<float> values = to_grid(value, given, volume.size, 3);
            const auto* first = reinterpret_cast<const glm::vec3*>(values.data());
            (volume.*field.member).assign(first, first + values.size() / 3);
        }
    }
    check_volume(volume);
    return volume;
}

}  // namespace

void bind_volumes(py::module_& module) {
    py::class_<Volume, std::shared_ptr<Volume>> volume(
        module, "Volume",
        "Box of cubic voxels of varying index, absorption, scattering and emission. Arrays have shape (z, y, x); "
        "values apply at the voxels' centres. Fields that are not given are those of vacuum.");
    volume.def(py::init(&make_from_arrays), py::arg("voxel"), py::kw_only(),
               py::arg("low") = py::make_tuple(0.0, 0.0, 0.0), py::arg("name") = "volume",
               "voxel: edge of a voxel, m. low: corner of the box, m. Fields by name: n, n_red, n_blue, sigma_a, "
               "sigma_s, g, emission, boundary.");
    volume.def_readonly("name", &Volume::name, "name for messages");
    volume.def_readonly("voxel", &Volume::voxel, "edge of a voxel, m");
    volume.def_property_readonly(
        "low", [](const Volume& v) { return from_vector(v.low); }, "lower corner of the box, m");
    volume.def_property_readonly(
        "high", [](const Volume& v) { return from_vector(v.high()); }, "upper corner of the box, m");
    for (const ScalarField& field : kScalars)
        volume.def_property_readonly(
            field.name,
            [field](const Volume& v) {
                return grid_array(v, (v.*field.member).data(), (v.*field.member).size(), false);
            },
            field.doc);
    for (const ColorField& field : kColors)
        volume.def_property_readonly(
            field.name,
            [field](const Volume& v) {
                const auto& values = v.*field.member;
                return grid_array(v, values.empty() ? nullptr : &values.front().x, values.size(), true);
            },
            field.doc);

    module.def("make_volume", &make_volume, py::arg("spec"),
               "Volume from NAME[,PARAMETER=VALUE...], the names of `pellucid help volumes`.");
    module.def(
        "load_volume", [](const std::filesystem::path& file) { return load_volume(file); }, py::arg("file"),
        "Volume from an OpenVDB file whose grids have the names of fields.");
    module.def(
        "save_volume", [](const std::filesystem::path& file, const Volume& saved) { save_volume(file, saved); },
        py::arg("file"), py::arg("volume"), "Saves each field as a grid of an OpenVDB file.");
}

}  // namespace pellucid::python
