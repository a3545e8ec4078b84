#include "bind.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace pellucid::python {
namespace {

Camera look_at(const py::object& eye_object, const py::object& target_object, const py::object& up_object,
               float vertical_fov) {
    const auto eye = to_vector<glm::dvec3>(eye_object, "eye"), target = to_vector<glm::dvec3>(target_object, "target");
    const auto up = to_vector<glm::dvec3>(up_object, "up");
    if (glm::length(glm::cross(target - eye, up)) == 0.0)
        throw Error("look_at: eye, target and up must not lie on one line");
    Camera camera;
    camera.world_from_view = glm::mat4(glm::inverse(glm::lookAt(eye, target, up)));
    camera.vertical_fov = vertical_fov;
    return camera;
}

/// Rows of the pinhole matrix in pixels, for a camera that looks along +Z with +Y down, as OpenCV has it.
py::array intrinsics(const Camera& camera, std::uint32_t width, std::uint32_t height) {
    if (camera.orthographic) throw Error("intrinsics: an orthographic camera has no pinhole matrix");
    const double focal = 0.5 * height / std::tan(0.5 * double(camera.vertical_fov));
    const std::array<double, 9> rows{focal, 0.0, 0.5 * width, 0.0, focal, 0.5 * height, 0.0, 0.0, 1.0};
    return py::array_t<double>({3, 3}, rows.data());
}

Light::Kind parse_kind(const std::string& name) {
    if (name == "directional") return Light::Kind::kDirectional;
    if (name == "point") return Light::Kind::kPoint;
    if (name == "spot") return Light::Kind::kSpot;
    throw unknown_name("kind of light", name, std::vector<std::string_view>{"directional", "point", "spot"});
}

const char* kind_name(Light::Kind kind) {
    return kind == Light::Kind::kDirectional ? "directional" : kind == Light::Kind::kPoint ? "point" : "spot";
}

void bind_lights(py::module_& module) {
    py::class_<Light> light(module, "Light", "Light of KHR_lights_punctual, with a size.");
    light.def_readwrite("name", &Light::name, "name for messages");
    light.def_property(
        "kind", [](const Light& l) { return kind_name(l.kind); },
        [](Light& l, const std::string& name) { l.kind = parse_kind(name); }, "directional, point or spot");
    vector_property(light, "intensity", &Light::intensity, "linear RGB, >= 0; point and spot W/sr, directional W/m2");
    vector_property(light, "position", &Light::position, "world, m; of point and spot lights");
    vector_property(light, "direction", &Light::direction, "unit, world: away from the light");
    light.def_readwrite("range", &Light::range, "m, > 0; point and spot lights end here");
    light.def_readwrite("inner_cone_angle", &Light::inner_cone_angle, "radians from the axis; full light up to here");
    light.def_readwrite("outer_cone_angle", &Light::outer_cone_angle, "radians from the axis; no light beyond");
    light.def_readwrite("radius", &Light::radius, "m, >= 0; sphere of point and spot lights");
    light.def_readwrite("angular_diameter", &Light::angular_diameter, "radians, 0..pi; disc of directional lights");
    init_by_names(light);
}

}  // namespace

void bind_cameras(py::module_& module) {
    bind_lights(module);
    py::class_<Camera> camera(module, "Camera", "Camera that looks along its own -Z with +Y up. Right-handed, metres.");
    camera.def_readwrite("name", &Camera::name, "name for messages");
    transform_property(camera, "world_from_view", &Camera::world_from_view, "rigid, shape (4, 4), world");
    camera.def_readwrite("vertical_fov", &Camera::vertical_fov, "vertical field of view, radians, 0..pi");
    camera.def_readwrite("near_plane", &Camera::near_plane, "m; 0: chosen from the scene");
    camera.def_readwrite("far_plane", &Camera::far_plane, "m; 0: chosen from the scene");
    camera.def_readwrite("orthographic", &Camera::orthographic, "True: parallel view rays");
    camera.def_readwrite("vertical_extent", &Camera::vertical_extent, "m; height of an orthographic image");
    camera.def_static("look_at", &look_at, py::arg("eye"), py::arg("target"),
                      py::arg("up") = py::make_tuple(0.0, 1.0, 0.0), py::arg("vertical_fov") = Camera{}.vertical_fov,
                      "Camera at `eye` that looks at `target` (world, m). vertical_fov: radians, 0..pi.");
    camera.def("intrinsics", &intrinsics, py::arg("width"), py::arg("height"),
               "float64, shape (3, 3): pinhole matrix in pixels, for axes right, down and forward.");
    init_by_names(camera);

    py::class_<Bounds> bounds(module, "Bounds", "Sphere around objects, and their box about the same centre.");
    bounds.def_property_readonly(
        "center", [](const Bounds& b) { return from_vector(b.center); }, "world, m");
    bounds.def_readonly("radius", &Bounds::radius, "radius of the sphere, m");
    bounds.def_property_readonly(
        "half_size", [](const Bounds& b) { return from_vector(b.half_size); }, "half the sides of the box, m");

    module.def("orbit_camera", &orbit_camera, py::arg("bounds"), py::arg("azimuth_deg"), py::arg("elevation_deg"),
               py::arg("distance"), py::arg("vertical_fov") = Camera{}.vertical_fov,
               "Camera on a sphere around `bounds`. azimuth_deg 0 looks along -Z; elevation_deg -90..90; distance in "
               "radii, > 1; vertical_fov in radians.");
    module.def("framing_camera", &framing_camera, py::arg("bounds"), py::arg("width"), py::arg("height"),
               py::arg("vertical_fov") = Camera{}.vertical_fov,
               "Default camera: `bounds` fill 70% of the image's height. vertical_fov in radians.");
}

}  // namespace pellucid::python
