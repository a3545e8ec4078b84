#pragma once

// Scenes of few objects, and what they are made of.
#include "test_meshes.h"

#include <pellucid/environment.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <utility>

namespace pellucid::test {

inline Material glass(float ior = 1.5f) {
    Material material;
    material.transmission = 1.0f;
    material.thickness = 1.0f;
    material.ior = ior;
    return material;
}

/// `mesh` with the normals of its triangles.
inline Mesh with_flat_normals(const Mesh& mesh) {
    Mesh flat = unwelded(mesh);
    flat.normals.resize(flat.positions.size());
    for (const glm::uvec3 t : flat.triangles)
        for (int k = 0; k < 3; ++k) flat.normals[t[k]] = face_normal(flat, t);
    return flat;
}

inline Mesh inside_out(Mesh mesh) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (glm::vec3& n : mesh.normals) n = -n;
    return mesh;
}

/// A prism along Z, 4 m long, over a triangle in the XY plane, counter-clockwise.
inline Mesh prism(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    Mesh mesh;
    for (const float z : {-2.0f, 2.0f})
        for (const glm::vec2 p : {a, b, c}) mesh.positions.emplace_back(p, z);
    mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return with_flat_normals(mesh);
}

/// A square of 2 m in the plane z = 0 that faces +Z.
inline Mesh square() {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.normals.assign(4, {0, 0, 1});
    return mesh;
}

inline void add(Scene& scene, Mesh mesh, const Material& material, const glm::mat4& world_from_object = glm::mat4(1)) {
    Object object;
    object.mesh = int(scene.meshes.size());
    object.material = int(scene.materials.size());
    object.world_from_object = world_from_object;
    scene.meshes.push_back(std::move(mesh));
    scene.materials.push_back(material);
    scene.objects.push_back(object);
}

inline Scene scene_of(Mesh mesh, const Material& material = glass()) {
    Scene scene;
    add(scene, std::move(mesh), material);
    return scene;
}

inline Environment uniform(float radiance) {
    Environment environment;
    environment.kind = Environment::Kind::kUniform;
    environment.uniform_radiance = glm::vec3(radiance);
    return environment;
}

}  // namespace pellucid::test
