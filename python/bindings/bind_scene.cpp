#include "bind.h"

#include <pybind11/stl.h>

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::python {
namespace {

template <class Item>
Item& item(std::vector<Item>& items, int index, const char* what) {
    if (index < 0 || std::size_t(index) >= items.size())
        throw Error(fmt::format("there is no {} {}; the scene has {}", what, index, items.size()));
    return items[std::size_t(index)];
}

template <class Vector>
void set_optional(std::vector<Vector>& target, const py::object& given, const char* what) {
    if (!given.is_none()) target = to_vectors<Vector>(given, what);
}

int add_mesh(Scene& scene, const py::object& vertices, const py::object& faces, const py::object& normals,
             const py::object& texcoords, const py::object& colors, const std::string& name,
             std::optional<float> crease_angle) {
    Mesh mesh;
    mesh.name = name;
    mesh.positions = to_vectors<glm::vec3>(vertices, "vertices");
    mesh.triangles = to_triangles(faces, "faces");
    set_optional(mesh.normals, normals, "normals");
    set_optional(mesh.texcoords[0], texcoords, "texcoords");
    set_optional(mesh.colors, colors, "colors");
    if (normals.is_none()) mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
    check_mesh(mesh, fmt::format("mesh {} '{}'", scene.meshes.size(), name));
    if (normals.is_none()) make_normals(mesh, crease_angle.value_or(kSmooth));
    scene.meshes.push_back(std::move(mesh));
    return int(scene.meshes.size()) - 1;
}

int add_object(Scene& scene, int mesh, int material, const py::object& transform, const std::string& name, int body,
               int priority) {
    item(scene.meshes, mesh, "mesh");
    item(scene.materials, material, "material");
    Object object;
    object.name = name;
    object.mesh = mesh;
    object.material = material;
    object.body = body;
    object.priority = priority;
    if (!transform.is_none()) object.world_from_object = to_transform(transform, "transform");
    scene.objects.push_back(std::move(object));
    return int(scene.objects.size()) - 1;
}

int add_image(Scene& scene, const py::object& pixels, const std::string& name) {
    scene.images.push_back(to_image(pixels, "pixels"));
    scene.image_names.push_back(name);
    return int(scene.images.size()) - 1;
}

int add_volume(Scene& scene, const std::shared_ptr<Volume>& volume, const py::object& transform,
               const std::string& name) {
    VolumeObject object;
    object.name = name;
    object.volume = int(scene.volumes.size());
    if (!transform.is_none()) object.world_from_volume = to_transform(transform, "transform");
    scene.volumes.push_back(std::make_shared<const Volume>(*volume));
    scene.volume_objects.push_back(std::move(object));
    return int(scene.volume_objects.size()) - 1;
}

template <class Item>
int append(std::vector<Item>& items, const Item& added) {
    items.push_back(added);
    return int(items.size()) - 1;
}

Scene load(const std::string& source, std::optional<float> ior, const py::object& attenuation_color,
           std::optional<float> attenuation_distance, std::optional<float> crease_angle, bool remake_normals,
           bool solid, const std::optional<std::string>& animation, std::optional<double> time_s, bool allow_outside) {
    LoadOptions options;
    options.ior = ior;
    if (!attenuation_color.is_none())
        options.attenuation_color = to_vector<glm::vec3>(attenuation_color, "attenuation_color");
    options.attenuation_distance = attenuation_distance;
    if (crease_angle) options.crease_angle = *crease_angle;
    options.remake_normals = remake_normals;
    options.solid = solid;
    options.animation = animation;
    options.time_s = time_s;
    options.allow_outside = allow_outside;
    const py::gil_scoped_release release;
    return load_scene(source, options);
}

void bind_objects(py::module_& module) {
    py::class_<Object> object(module, "Object", "One placement of a mesh.");
    object.def_readonly("name", &Object::name, "name for messages");
    object.def_readonly("mesh", &Object::mesh, "index of the mesh");
    object.def_readonly("material", &Object::material, "index of the material");
    object.def_property_readonly(
        "transform", [](const Object& o) { return from_transform(o.world_from_object); },
        "world from object, shape (4, 4)");
    object.def_readonly("body", &Object::body, "objects of one number >= 0 bound one solid together; -1: its own");
    object.def_readonly("priority", &Object::priority, "the solid of highest priority displaces others");
}

void bind_pose(py::module_& module, py::class_<Scene>& scene) {
    py::class_<Pose>(module, "Pose", "A scene at one time of an animation, for Renderer.set_pose().");
    py::class_<AnimationInfo> info(module, "Animation", "One animation of a scene's file.");
    info.def_readonly("name", &AnimationInfo::name, "name in the file");
    info.def_readonly("duration_s", &AnimationInfo::duration_s, "time of the last keyframe, s");
    scene.def_property_readonly(
        "animations", [](const Scene& s) { return animations(s); }, "animations of the scene's file");
    scene.def(
        "pose",
        [](const Scene& s, double time_s, const std::string& animation) {
            return pose_at(s, find_animation(s, animation), time_s);
        },
        py::arg("time_s"), py::arg("animation") = "0",
        "The scene at time_s (s, >= 0; clamped to the end) of an animation, by name or number.");
}

void bind_contents(py::class_<Scene>& scene) {
    scene.def_readonly("source", &Scene::source, "what load_scene() was given");
    scene.def_property_readonly(
        "origin", [](const Scene& s) { return from_vector(s.origin); },
        "float64 (3,): position of the scene's origin in the file's world, m");
    scene.def_property_readonly(
        "materials", [](const Scene& s) { return s.materials; }, "copies of the materials; see set_material()");
    scene.def_property_readonly(
        "objects", [](const Scene& s) { return s.objects; }, "copies of the objects; see set_transform()");
    scene.def_property_readonly(
        "lights", [](const Scene& s) { return s.lights; }, "copies of the lights; see set_light()");
    scene.def_readwrite("cameras", &Scene::cameras, "list of cameras; the first is the default one");
    scene.def_readonly("warnings", &Scene::warnings, "what was approximated, repaired or left out, a line each");
    scene.def_property_readonly("triangle_count", &Scene::triangle_count, "triangles over all objects");
    scene.def_property_readonly("bounds", &scene_bounds, "bounds of all objects and volumes, world, m");
    scene.def_property_readonly(
        "mesh_count", [](const Scene& s) { return s.meshes.size(); }, "number of meshes");
    const auto array_of = [&](const char* name, auto member, const char* doc) {
        scene.def(
            name, [member](Scene& s, int mesh) { return from_vectors(item(s.meshes, mesh, "mesh").*member); },
            py::arg("mesh"), doc);
    };
    array_of("vertices", &Mesh::positions, "float32 (n, 3): positions in the mesh's own frame, m; a copy");
    array_of("normals", &Mesh::normals, "float32 (n, 3): unit normals in the mesh's own frame; a copy");
    array_of("faces", &Mesh::triangles, "uint32 (m, 3): corners, counter-clockwise from outside; a copy");
}

void bind_changes(py::class_<Scene>& scene) {
    scene.def(
        "set_transform",
        [](Scene& s, int object, const py::object& transform) {
            item(s.objects, object, "object").world_from_object = to_transform(transform, "transform");
        },
        py::arg("object"), py::arg("transform"), "Places an object: world from object, shape (4, 4), invertible.");
    scene.def(
        "set_material", [](Scene& s, int index, const Material& m) { item(s.materials, index, "material") = m; },
        py::arg("index"), py::arg("material"), "Replaces a material.");
    scene.def(
        "set_light", [](Scene& s, int index, const Light& l) { item(s.lights, index, "light") = l; }, py::arg("index"),
        py::arg("light"), "Replaces a light.");
}

}  // namespace

void bind_scene(py::module_& module) {
    bind_objects(module);
    py::class_<Scene> scene(module, "Scene", "Materials, meshes and their placements, lights, cameras and volumes.");
    scene.def(py::init<>(), "An empty scene.");
    scene.def(
        "add_material", [](Scene& s, const Material& m) { return append(s.materials, m); }, py::arg("material"),
        "Adds a material and returns its index.");
    scene.def("add_image", &add_image, py::arg("pixels"), py::arg("name") = "image",
              "Adds an image for textures and returns its index. pixels: shape (height, width[, channels]), 0..1.");
    scene.def("add_mesh", &add_mesh, py::arg("vertices"), py::arg("faces"), py::arg("normals") = py::none(),
              py::arg("texcoords") = py::none(), py::arg("colors") = py::none(), py::arg("name") = "mesh",
              py::arg("crease_angle") = py::none(),
              "Adds a mesh and returns its index. vertices: (n, 3), m. faces: integers (m, 3), counter-clockwise from "
              "outside. normals: (n, 3), unit; by default smooth ones are made. texcoords: (n, 2). colors: linear "
              "RGBA (n, 4). crease_angle (radians): edges bent by more stay sharp, which adds vertices.");
    scene.def("add_object", &add_object, py::arg("mesh"), py::arg("material"), py::arg("transform") = py::none(),
              py::arg("name") = "object", py::arg("body") = -1, py::arg("priority") = 0,
              "Places a mesh and returns the object's index. transform: world from object, shape (4, 4).");
    scene.def(
        "add_light", [](Scene& s, const Light& l) { return append(s.lights, l); }, py::arg("light"),
        "Adds a light and returns its index.");
    scene.def("add_volume", &add_volume, py::arg("volume"), py::arg("transform") = py::none(),
              py::arg("name") = "volume",
              "Places a volume and returns the placement's index. transform: a similarity, shape (4, 4).");
    bind_contents(scene);
    bind_changes(scene);
    bind_pose(module, scene);

    module.def("load_scene", &load, py::arg("source"), py::kw_only(), py::arg("ior") = py::none(),
               py::arg("attenuation_color") = py::none(), py::arg("attenuation_distance") = py::none(),
               py::arg("crease_angle") = py::none(), py::arg("remake_normals") = false, py::arg("solid") = false,
               py::arg("animation") = py::none(), py::arg("time_s") = py::none(), py::arg("allow_outside") = false,
               "Scene of a file (.gltf, .glb, .obj, .ply, .stl, .off, .3ds, .vdb), shape:NAME or volume:NAME. ior "
               "(>= 1), attenuation_color (RGB 0..1) and attenuation_distance (m) replace those of all glass; "
               "crease_angle in radians, time_s in s. allow_outside: the file may name others outside its folder.");
}

}  // namespace pellucid::python
