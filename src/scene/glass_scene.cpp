#include "scene/glass_scene.h"

#include "scene/mesh_repair.h"

#include <utility>

namespace pellucid {

Scene glass_scene(Mesh mesh, const LoadOptions& options, bool keep_normals, Warnings& warnings) {
    MeshOrigin origin;
    origin.refractive = true;
    origin.make_normals = mesh.normals.empty() || !keep_normals;
    origin.crease_angle = options.crease_angle;
    repair_mesh(mesh, origin, warnings);

    Material glass;
    glass.name = "glass";
    glass.transmission = 1.0f;
    glass.thickness = 1.0f;
    Object object;
    object.name = mesh.name;

    Scene scene;
    scene.materials.push_back(std::move(glass));
    scene.meshes.push_back(std::move(mesh));
    scene.objects.push_back(std::move(object));
    return scene;
}

}  // namespace pellucid
