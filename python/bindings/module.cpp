#include "bind.h"

PYBIND11_MODULE(_pellucid, module) {
    using namespace pellucid::python;
    module.attr("__version__") = std::string(pellucid::version());
    bind_errors(module);
    bind_registry(module);
    bind_materials(module);
    bind_volumes(module);
    bind_cameras(module);
    bind_scene(module);
    bind_environment(module);
    bind_renderer(module);
    bind_tracer(module);
    bind_measures(module);
}
