#include "bind.h"

#include <pybind11/stl.h>

namespace pellucid::python {
namespace {

py::dict values_of(const ParameterInfo& parameter) {
    py::dict names;
    for (const NamedValue& value : parameter.names) names[py::str(std::string(value.name))] = value.value;
    return names;
}

void bind_parameter(py::module_& module) {
    py::class_<ParameterInfo> parameter(module, "Parameter", "One number that a technique can be given.");
    parameter.def_readonly("name", &ParameterInfo::name, "name, as on the command line");
    parameter.def_readonly("unit", &ParameterInfo::unit, "m, px, or empty for a plain number");
    parameter.def_readonly("default", &ParameterInfo::default_value, "value where none is given");
    parameter.def_readonly("minimum", &ParameterInfo::minimum, "least value");
    parameter.def_readonly("maximum", &ParameterInfo::maximum, "greatest value");
    parameter.def_readonly("whole", &ParameterInfo::whole, "True: whole numbers only");
    parameter.def_readonly("doc", &ParameterInfo::doc, "one line");
    parameter.def_property_readonly("names", &values_of, "dict of the values that have names");
}

void bind_technique(py::module_& module) {
    py::class_<TechniqueInfo> technique(module, "Technique", "A way to compute refraction, as the registry lists it.");
    technique.def_readonly("name", &TechniqueInfo::name, "name, as on the command line");
    technique.def_readonly("summary", &TechniqueInfo::summary, "one line");
    technique.def_property_readonly(
        "source",
        [](const TechniqueInfo& t) {
            return py::dict(py::arg("authors") = t.source.authors, py::arg("title") = t.source.title,
                            py::arg("venue") = t.source.venue, py::arg("year") = t.source.year,
                            py::arg("section") = t.source.section);
        },
        "publication: authors, title, venue, year, section");
    technique.def_property_readonly(
        "parameters",
        [](const TechniqueInfo& t) { return std::vector<ParameterInfo>(t.parameters.begin(), t.parameters.end()); },
        "list of parameters");
    technique.def_readonly("reference", &TechniqueInfo::reference, "True: a truth that others are measured against");
    technique.def_readonly("all_light", &TechniqueInfo::all_light, "True: its image has all light");
    technique.def_readonly("whole_scene", &TechniqueInfo::whole_scene, "True: refracted rays meet everything");
    technique.def_readonly("volumes", &TechniqueInfo::volumes, "True: draws volumes");
}

}  // namespace

void bind_errors(py::module_& module) {
    static const auto error = py::register_exception<Error>(module, "Error", PyExc_ValueError);
    error.attr("__doc__") = "Bad input: a file, name or value that cannot be used. One line.";
    static const auto device = py::register_exception<DeviceError>(module, "DeviceError", PyExc_RuntimeError);
    device.attr("__doc__") = "No Vulkan device offers what is needed. One line.";
}

void bind_registry(py::module_& module) {
    bind_parameter(module);
    bind_technique(module);
    module.def(
        "techniques",
        [] {
            std::vector<TechniqueInfo> all;
            for (const TechniqueInfo* each : techniques()) all.push_back(*each);
            return all;
        },
        "Every technique of the registry.");
    module.def(
        "presets",
        [] {
            py::dict all;
            for (const PresetInfo& preset : presets())
                all[py::str(std::string(preset.name))] = std::string(preset.summary);
            return all;
        },
        "dict of presets with a line about each.");
    module.def(
        "aovs",
        [] {
            py::dict all;
            for (const AovInfo& aov : aov_infos())
                all[py::str(std::string(aov.name))] = py::make_tuple(aov.channels, std::string(aov.doc));
            return all;
        },
        "dict of AOVs: number of channels and a line about each.");
    module.def(
        "devices",
        [] {
            py::list all;
            for (const DeviceInfo& device : list_devices())
                all.append(py::dict(py::arg("name") = device.name, py::arg("driver") = device.driver,
                                    py::arg("type") = device.type, py::arg("missing") = device.missing));
            return all;
        },
        "Every Vulkan device: name, driver, type, and the required features that are missing.");
}

}  // namespace pellucid::python
