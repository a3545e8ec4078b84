#include "bind.h"

namespace pellucid::python {
namespace {

Environment make_environment(const py::object& source, float rotation, float intensity) {
    Environment environment;
    if (py::isinstance<py::str>(source)) {
        environment = load_environment(py::cast<std::string>(source));
    } else if (py::hasattr(source, "__fspath__")) {
        environment = load_environment(py::str(source.attr("__fspath__")()));
    } else {
        environment.kind = Environment::Kind::kMap;
        environment.map = to_image(source, "environment", 3);
    }
    environment.rotation = rotation;
    environment.intensity = intensity;
    return environment;
}

}  // namespace

void bind_environment(py::module_& module) {
    py::class_<Environment> environment(module, "Environment", "Light that arrives from infinitely far away.");
    environment.def(py::init(&make_environment), py::arg("source") = "studio", py::arg("rotation") = 0.0f,
                    py::arg("intensity") = 1.0f,
                    "source: studio, checker, sky, uniform, an equirectangular .hdr or .exr file, or an array of shape "
                    "(height, width, 3) of linear radiance. rotation: radians about +Y. intensity: factor, >= 0.");
    environment.def_readwrite("rotation", &Environment::rotation, "radians, right-handed about +Y");
    environment.def_readwrite("intensity", &Environment::intensity, "factor of the radiance, >= 0");
    environment.def(
        "radiance",
        [](const Environment& e, const py::object& direction) {
            return from_vector(radiance(e, to_vector<glm::vec3>(direction, "direction")));
        },
        py::arg("direction"), "Linear RGB from a direction (unit, world, away from the scene).");
}

}  // namespace pellucid::python
