#pragma once

#include "arrays.h"

#include <pellucid/names.h>

#include <memory>
#include <string_view>
#include <vector>

namespace pellucid::python {

/// Each function adds its part to the module.
void bind_errors(py::module_& module);
void bind_registry(py::module_& module);
void bind_materials(py::module_& module);
void bind_volumes(py::module_& module);
void bind_cameras(py::module_& module);
void bind_scene(py::module_& module);
void bind_environment(py::module_& module);
void bind_renderer(py::module_& module);
void bind_tracer(py::module_& module);
void bind_measures(py::module_& module);

/// A property that is a vector: read as an array, written as any sequence of as many numbers.
template <class Class, class Vector>
void vector_property(py::class_<Class>& bound, const char* name, Vector Class::*member, const char* doc) {
    bound.def_property(
        name, [member](const Class& object) { return from_vector(object.*member); },
        [member, name](Class& object, const py::object& value) { object.*member = to_vector<Vector>(value, name); },
        doc);
}

/// A property that is a transform: an array of shape (4, 4).
template <class Class>
void transform_property(py::class_<Class>& bound, const char* name, glm::mat4 Class::*member, const char* doc) {
    bound.def_property(
        name, [member](const Class& object) { return from_transform(object.*member); },
        [member, name](Class& object, const py::object& value) { object.*member = to_transform(value, name); }, doc);
}

/// A constructor that takes the properties by name. Call it after the properties were added.
template <class Class>
void init_by_names(py::class_<Class>& bound) {
    const py::object type = bound;
    std::vector<std::string> known;
    for (const auto& [name, value] : py::dict(bound.attr("__dict__")))
        if (py::isinstance<py::str>(name) && py::hasattr(value, "fset") && !value.attr("fset").is_none())
            known.push_back(py::str(name));
    bound.def(py::init([known](const py::kwargs& properties) {
                  auto object = std::make_unique<Class>();
                  const py::object view = py::cast(object.get(), py::return_value_policy::reference);
                  for (const auto& [name, value] : properties) {
                      const std::string key = py::str(name);
                      if (std::find(known.begin(), known.end(), key) == known.end())
                          throw unknown_name("property", key,
                                             std::vector<std::string_view>(known.begin(), known.end()));
                      view.attr(name) = value;
                  }
                  return object;
              }),
              "Takes every property by name; the others have their defaults.");
}

/// Runs `work` while other Python threads run.
template <class Work>
auto without_gil(Work&& work) {
    const py::gil_scoped_release release;
    return work();
}

/// Calls a Python function with the finished share, 0..1, from threads that do not hold the GIL. An exception of the
/// function ends the calls; rethrow() raises it when the work is done.
class PythonProgress {
public:
    explicit PythonProgress(py::object function) : function_(std::move(function)) {}
    Progress progress();
    void rethrow();

private:
    py::object function_;
    std::unique_ptr<py::error_already_set> error_;
};

/// Structured array of RefractedPath, of shape (height, width), that owns the paths.
py::array path_array(std::vector<RefractedPath>&& paths, std::uint32_t width, std::uint32_t height);
/// Paths of such an array. Throws Error naming `what` for another type.
std::vector<RefractedPath> to_paths(const py::handle& object, const std::string& what);

}  // namespace pellucid::python
