#include "bind.h"

#include <pybind11/stl.h>

#include <fmt/format.h>

#include <mutex>
#include <optional>

namespace pellucid::python {
namespace {

/// An image with its other quantities, as arrays that own their pixels.
struct Frame {
    py::array radiance, display;
    py::dict aovs;
    py::object paths, standard_error, sample_counts;
    std::vector<std::string> warnings;
    py::dict status;
    std::uint64_t covered = 0;
    std::vector<std::vector<PassTime>> frames;
};

/// The number that a named value of a parameter stands for.
double parameter_value(const std::string& name, const py::handle& value) {
    if (!py::isinstance<py::str>(value)) {
        const double number = PyFloat_AsDouble(value.ptr());
        if (PyErr_Occurred() == nullptr) return number;
        PyErr_Clear();
        throw Error(fmt::format("parameter {}: must be a number or a name", name));
    }
    const std::string text = py::cast<std::string>(value);
    std::vector<std::string_view> known;
    for (const TechniqueInfo* technique : techniques())
        for (const ParameterInfo& parameter : technique->parameters) {
            if (parameter.name != name) continue;
            for (const NamedValue& named : parameter.names) {
                if (named.name == text) return named.value;
                if (std::find(known.begin(), known.end(), named.name) == known.end()) known.push_back(named.name);
            }
        }
    throw unknown_name("value of " + name, text, known);
}

Frame to_frame(RenderResult&& result, const RenderSettings& settings) {
    Frame frame;
    frame.radiance = image_array(std::move(result.radiance));
    frame.display = image_array(std::move(result.display));
    for (auto& [name, image] : result.aovs) frame.aovs[py::str(name)] = image_array(std::move(image));
    frame.paths =
        settings.paths ? py::object(path_array(std::move(result.paths), settings.width, settings.height)) : py::none();
    const auto optional_image = [](Image& image) {
        return image.pixels.empty() ? py::object(py::none()) : py::object(image_array(std::move(image)));
    };
    frame.standard_error = optional_image(result.standard_error);
    frame.sample_counts = optional_image(result.sample_counts);
    frame.warnings = std::move(result.warnings);
    for (std::uint32_t i = 0; i < kStatusCount; ++i)
        frame.status[py::str(std::string(status_name(Status(i))))] = result.status[i];
    frame.covered = result.covered;
    frame.frames = std::move(result.frames);
    return frame;
}

/// A renderer that one Python thread at a time uses, while others run.
class PythonRenderer {
public:
    PythonRenderer(std::string device, std::uint32_t threads, bool validation)
        : renderer_(without_gil([&] {
              return Renderer(DeviceOptions{.device = std::move(device), .validation = validation, .threads = threads});
          })) {}

    void set_scene(const Scene& scene) {
        locked([&] { renderer_.set_scene(scene); });
        meshes_.clear();
        for (const Mesh& mesh : scene.meshes) meshes_.emplace_back().triangles = mesh.triangles;
    }
    void set_environment(const py::object& environment) {
        const Environment chosen = py::isinstance<Environment>(environment)
                                       ? py::cast<Environment>(environment)
                                       : py::cast<Environment>(py::type::of<Environment>()(environment));
        locked([&] { renderer_.set_environment(chosen); });
    }
    void set_camera(const Camera& camera) {
        locked([&] { renderer_.set_camera(camera); });
    }
    void set_vertices(int mesh, const py::object& vertices, const py::object& normals) {
        if (mesh < 0 || std::size_t(mesh) >= meshes_.size())
            throw Error(fmt::format("there is no mesh {}; the scene has {}", mesh, meshes_.size()));
        const Floats positions = rows_of_floats(vertices, "vertices", 3);
        const std::span<const glm::vec3> moved = span_of(positions);
        Floats given;
        if (!normals.is_none()) given = rows_of_floats(normals, "normals", 3);
        locked([&] {
            std::vector<glm::vec3> made;
            if (given.size() == 0) made = smooth_normals(mesh, moved);
            const std::span<const glm::vec3> turned = made.empty() ? span_of(given) : std::span<const glm::vec3>(made);
            renderer_.set_positions({{.mesh = mesh, .positions = moved, .normals = turned}});
        });
    }
    void set_transform(int object, const py::object& transform) {
        const PosedObject posed{.object = object, .world_from_object = to_transform(transform, "transform")};
        locked([&] { renderer_.set_transforms({posed}); });
    }
    void set_pose(const Pose& pose) {
        locked([&] {
            renderer_.set_positions(pose.moved_meshes());
            renderer_.set_transforms(pose.objects);
        });
    }
    void set_material(int index, const Material& material) {
        locked([&] { renderer_.set_material(index, material); });
    }
    void set_light(int index, const Light& light) {
        locked([&] { renderer_.set_light(index, light); });
    }
    void set_lights(const std::vector<Light>& lights) {
        locked([&] { renderer_.set_lights(lights); });
    }

    Frame render(RenderSettings settings, const py::object& progress) {
        PythonProgress calls(progress);
        settings.progress = calls.progress();
        std::optional<RenderResult> result;
        locked([&] { result = renderer_.render(settings); });
        calls.rethrow();
        return to_frame(std::move(*result), settings);
    }
    py::array thickness(ThicknessRequest request, const py::object& progress) {
        PythonProgress calls(progress);
        request.progress = calls.progress();
        std::optional<ThicknessResult> result;
        locked([&] { result = renderer_.measure_thickness(request); });
        calls.rethrow();
        return image_array(std::move(result->thickness));
    }

    py::dict device() const {
        const DeviceInfo& info = renderer_.device();
        return py::dict(py::arg("name") = info.name, py::arg("driver") = info.driver, py::arg("type") = info.type);
    }
    py::tuple choose(const std::string& name) const {
        const TechniqueChoice choice = renderer_.choose(name);
        return py::make_tuple(std::string(choice.technique->name), py::cast(choice.parameters), choice.reason);
    }
    const std::vector<std::string>& validation_messages() const { return renderer_.validation_messages(); }

private:
    template <class Work>
    void locked(Work&& work) {
        const py::gil_scoped_release release;
        const std::lock_guard lock(mutex_);
        work();
    }
    static std::span<const glm::vec3> span_of(const Floats& rows) {
        return {reinterpret_cast<const glm::vec3*>(rows.data()), std::size_t(rows.size()) / 3};
    }
    std::vector<glm::vec3> smooth_normals(int mesh, std::span<const glm::vec3> positions) const {
        Mesh moved = meshes_[std::size_t(mesh)];
        moved.positions.assign(positions.begin(), positions.end());
        moved.normals.assign(positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
        check_mesh(moved, fmt::format("mesh {}", mesh));
        make_normals(moved, kSmooth);
        return std::move(moved.normals);
    }

    Renderer renderer_;
    std::vector<Mesh> meshes_;  ///< triangles only
    std::mutex mutex_;
};

RenderSettings to_settings(std::uint32_t width, std::uint32_t height, const std::string& technique,
                           const py::dict& parameters, std::uint32_t samples, std::uint32_t first_sample, float error,
                           std::uint32_t most_samples, const std::vector<std::string>& aovs, bool paths,
                           const std::string& view, const std::string& tonemap, float exposure_ev,
                           const std::string& light, const std::string& shadows, bool still) {
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.technique = technique;
    for (const auto& [name, value] : parameters) {
        const std::string key = py::str(name);
        settings.parameters[key] = parameter_value(key, value);
    }
    settings.samples = samples;
    settings.first_sample = first_sample;
    settings.error = error;
    settings.most_samples = most_samples;
    settings.aovs = aovs;
    settings.paths = paths;
    settings.view = parse_view(view);
    settings.tonemap = parse_tonemap(tonemap);
    settings.exposure_ev = exposure_ev;
    settings.light.transport = parse_light_transport(light);
    settings.light.shadows = parse_shadows(shadows);
    settings.still = still;
    return settings;
}

void bind_frame(py::module_& module) {
    py::class_<Frame> frame(module, "Frame",
                            "What Renderer.render() returns. Arrays own their pixels; rows from the top.");
    frame.def_readonly("radiance", &Frame::radiance, "float32 (height, width, 3): linear radiance before exposure");
    frame.def_readonly("display", &Frame::display, "float32 (height, width, 3), 0..1: tone mapped, sRGB-encoded");
    frame.def_readonly("aovs", &Frame::aovs,
                       "dict of float32 arrays, (height, width) or (height, width, channels); see aovs()");
    frame.def_readonly("paths", &Frame::paths, "structured array (height, width) of paths, if asked for; else None");
    frame.def_readonly("standard_error", &Frame::standard_error,
                       "float32 (height, width, 3): of the radiance, if the technique estimates it; else None");
    frame.def_readonly("sample_counts", &Frame::sample_counts,
                       "float32 (height, width): samples of each pixel, if `error` chose them; else None");
    frame.def_readonly("warnings", &Frame::warnings, "differences between the scene and its image, a line each");
    frame.def_readonly("status", &Frame::status, "dict: number of covered pixels by status");
    frame.def_readonly("covered", &Frame::covered, "pixels whose first surface is refracting glass");
    frame.def_property_readonly(
        "passes",
        [](const Frame& f) {
            py::list all;
            for (const auto& passes : f.frames) {
                py::dict times;
                for (const PassTime& pass : passes) times[py::str(pass.name)] = pass.time_ms;
                all.append(times);
            }
            return all;
        },
        "list of one dict per sample: time of each pass on the device, ms");
}

void bind_render(py::class_<PythonRenderer>& renderer) {
    const RenderSettings defaults;
    renderer.def(
        "render",
        [](PythonRenderer& self, std::uint32_t width, std::uint32_t height, const std::string& technique,
           const py::dict& parameters, std::uint32_t samples, std::uint32_t first_sample, float error,
           std::uint32_t most_samples, const std::vector<std::string>& aovs, bool paths, const std::string& view,
           const std::string& tonemap, float exposure_ev, const std::string& light, const std::string& shadows,
           bool still, const py::object& progress) {
            return self.render(
                to_settings(width, height, technique, parameters, samples, first_sample, error, most_samples, aovs,
                            paths, view, tonemap, exposure_ev, light, shadows, still),
                progress);
        },
        py::arg("width") = defaults.width, py::arg("height") = defaults.height,
        py::arg("technique") = defaults.technique, py::arg("parameters") = py::dict(), py::kw_only(),
        py::arg("samples") = defaults.samples, py::arg("first_sample") = defaults.first_sample,
        py::arg("error") = defaults.error, py::arg("most_samples") = defaults.most_samples,
        py::arg("aovs") = py::list(), py::arg("paths") = false, py::arg("view") = "radiance",
        py::arg("tonemap") = "neutral", py::arg("exposure_ev") = defaults.exposure_ev, py::arg("light") = "automatic",
        py::arg("shadows") = "exact", py::arg("still") = true, py::arg("progress") = py::none(),
        "Renders the scene into a Frame; other Python threads run meanwhile. width, height: pixels. technique: name of "
        "a technique or preset. parameters: dict of numbers or names of values. samples: jittered frames, averaged. "
        "error: above 0, samples each pixel until its relative standard error is that. aovs: names of aovs(), taken "
        "at pixel centres. exposure_ev: stops. progress: called with the finished share, 0..1.");
    renderer.def(
        "thickness",
        [](PythonRenderer& self, std::uint32_t width, std::uint32_t height, std::uint32_t light,
           const std::string& method, std::uint32_t layers, std::uint32_t resolution, const py::object& progress) {
            return self.thickness(
                {.width = width,
                 .height = height,
                 .settings = {.method = parse_thickness_method(method), .layers = layers, .resolution = resolution},
                 .light = light,
                 .progress = {}},
                progress);
        },
        py::arg("width") = 512, py::arg("height") = 512, py::kw_only(), py::arg("light") = 0,
        py::arg("method") = "layers", py::arg("layers") = 8, py::arg("resolution") = 1024,
        py::arg("progress") = py::none(),
        "float32 (height, width), m: solid between a light of the scene and each visible point of a translucent "
        "surface; -1: not translucent or out of the light's reach; -2: shadowed.");
}

void bind_setters(py::class_<PythonRenderer>& renderer) {
    renderer.def("set_scene", &PythonRenderer::set_scene, py::arg("scene"), "Uploads a copy of the scene.");
    renderer.def("set_environment", &PythonRenderer::set_environment, py::arg("environment"),
                 "Environment, or what its constructor takes as `source`.");
    renderer.def("set_camera", &PythonRenderer::set_camera, py::arg("camera"),
                 "Default: the scene's first camera, or one that frames the scene.");
    renderer.def("set_vertices", &PythonRenderer::set_vertices, py::arg("mesh"), py::arg("vertices"),
                 py::arg("normals") = py::none(),
                 "Moves the vertices of a mesh: (n, 3), as many as it has, in its own frame, m. normals: (n, 3), unit; "
                 "by default smooth ones are made.");
    renderer.def("set_transform", &PythonRenderer::set_transform, py::arg("object"), py::arg("transform"),
                 "Moves an object: world from object, shape (4, 4), invertible.");
    renderer.def("set_pose", &PythonRenderer::set_pose, py::arg("pose"), "Shows a pose of Scene.pose().");
    renderer.def("set_material", &PythonRenderer::set_material, py::arg("index"), py::arg("material"),
                 "Replaces a material; its textures must stay the same.");
    renderer.def("set_light", &PythonRenderer::set_light, py::arg("index"), py::arg("light"), "Replaces a light.");
    renderer.def("set_lights", &PythonRenderer::set_lights, py::arg("lights"), "Replaces all lights.");
}

}  // namespace

Progress PythonProgress::progress() {
    if (function_.is_none()) return {};
    return [this](double share) {
        const py::gil_scoped_acquire acquire;
        if (error_ != nullptr) return;
        try {
            function_(share);
        } catch (py::error_already_set& error) {
            error_ = std::make_unique<py::error_already_set>(std::move(error));
        }
    };
}

void PythonProgress::rethrow() {
    if (error_ != nullptr) throw py::error_already_set(std::move(*error_));
}

void bind_renderer(py::module_& module) {
    bind_frame(module);
    py::class_<PythonRenderer> renderer(module, "Renderer", "Draws scenes on one Vulkan device. Needs no window.");
    renderer.def(py::init<std::string, std::uint32_t, bool>(), py::arg("device") = "", py::arg("threads") = 0,
                 py::arg("validation") = false,
                 "device: number or part of a name; empty: the best. threads: of CPU tracing, 0: all cores. "
                 "validation: Vulkan's validation layer.");
    bind_setters(renderer);
    bind_render(renderer);
    renderer.def_property_readonly("device", &PythonRenderer::device, "name, driver and type of the device");
    renderer.def("choose", &PythonRenderer::choose, py::arg("name"),
                 "(technique, parameters, reason) that a name stands for on this device and in this scene.");
    renderer.def_property_readonly("validation_messages", &PythonRenderer::validation_messages,
                                   "messages of the validation layer");
}

}  // namespace pellucid::python
