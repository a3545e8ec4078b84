#include "bind.h"

#include <pybind11/stl.h>

#include <cstddef>
#include <optional>

namespace pellucid::python {
namespace {

py::dtype path_type() {
    py::list names, formats, offsets;
    const auto field = [&](const char* name, const char* format, std::size_t offset) {
        names.append(name);
        formats.append(format);
        offsets.append(offset);
    };
    field("direction", "3f4", offsetof(RefractedPath, direction));
    field("position", "3f4", offsetof(RefractedPath, position));
    field("transmittance", "3f4", offsetof(RefractedPath, transmittance));
    field("length_inside", "f4", offsetof(RefractedPath, length_inside));
    field("length", "f4", offsetof(RefractedPath, length));
    field("object", "i4", offsetof(RefractedPath, object));
    field("events", "u2", offsetof(RefractedPath, events));
    field("reflections", "u2", offsetof(RefractedPath, reflections));
    field("status", "u4", offsetof(RefractedPath, status));
    field("side_conflict", "?", offsetof(RefractedPath, side_conflict));
    return py::dtype(names, formats, offsets, sizeof(RefractedPath));
}

/// The exact tracer with the scene that it traces.
class PythonTracer {
public:
    PythonTracer(const Scene& scene, std::uint32_t threads) : scene_(std::make_unique<Scene>(scene)) {
        const py::gil_scoped_release release;
        tracer_.emplace(*scene_, TracerOptions{.threads = threads});
        thickness_.emplace(*scene_, threads);
    }
    py::array exact(const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t max_events,
                    const py::object& shift_px, std::uint32_t channel) const {
        ExactSettings settings;
        settings.width = width;
        settings.height = height;
        settings.max_events = max_events;
        settings.shift_px = to_vector<glm::dvec2>(shift_px, "shift_px");
        settings.channel = channel;
        std::vector<RefractedPath> paths = without_gil([&] { return tracer_->exact(camera, settings); });
        return path_array(std::move(paths), width, height);
    }
    py::array thickness(const Camera& camera, std::uint32_t width, std::uint32_t height, std::uint32_t light) const {
        return image_array(without_gil([&] { return thickness_->trace(camera, width, height, light); }));
    }

private:
    std::unique_ptr<Scene> scene_;
    std::optional<Tracer> tracer_;
    std::optional<ThicknessTracer> thickness_;
};

}  // namespace

py::array path_array(std::vector<RefractedPath>&& paths, std::uint32_t width, std::uint32_t height) {
    return owned_array(std::move(paths), path_type(), {py::ssize_t(height), py::ssize_t(width)});
}

std::vector<RefractedPath> to_paths(const py::handle& object, const std::string& what) {
    const py::array array = py::array::ensure(object);
    if (!array || !array.dtype().equal(path_type()))
        throw Error(what + ": must be an array of paths, as Tracer.exact() and Renderer.render(paths=True) return it");
    const py::array rows = py::array::ensure(array, py::array::c_style);
    const auto* first = static_cast<const RefractedPath*>(rows.data());
    return {first, first + rows.size()};
}

void bind_tracer(py::module_& module) {
    py::class_<PythonTracer> tracer(module, "Tracer", "Exact ray tracing on the CPU: the truth for all techniques.");
    tracer.def(py::init<const Scene&, std::uint32_t>(), py::arg("scene"), py::arg("threads") = 0,
               "Builds the hierarchy of a copy of the scene. threads: 0: all cores.");
    tracer.def("exact", &PythonTracer::exact, py::arg("camera"), py::arg("width") = 512, py::arg("height") = 512,
               py::kw_only(), py::arg("max_events") = 16, py::arg("shift_px") = py::make_tuple(0.0, 0.0),
               py::arg("channel") = 1,
               "Structured array (height, width), a path per pixel: direction (unit, world, after the last interface), "
               "position (world, m), transmittance (RGB 0..1), length_inside and length (m), object (-1: environment), "
               "events, reflections, status, side_conflict. shift_px: of the rays from the pixels' centres. channel: "
               "0 red, 1 green, 2 blue, in dispersive glass.");
    tracer.def("thickness", &PythonTracer::thickness, py::arg("camera"), py::arg("width") = 512,
               py::arg("height") = 512, py::arg("light") = 0,
               "float32 (height, width), m: exact thickness, as Renderer.thickness() has it.");
    module.attr("path_dtype") = path_type();
}

}  // namespace pellucid::python
