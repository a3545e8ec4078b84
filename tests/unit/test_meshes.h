#pragma once

// Small meshes with known answers.
#include <pellucid/scene.h>

#include <cmath>

namespace pellucid::test {

/// Unit cube around `center`, counter-clockwise from outside, 8 vertices, 12 triangles, no normals.
inline Mesh cube(float size = 1.0f, glm::vec3 center = glm::vec3(0.0f)) {
    Mesh mesh;
    mesh.name = "cube";
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(center + size * glm::vec3((i & 1) - 0.5f, (i >> 1 & 1) - 0.5f, (i >> 2) - 0.5f));
    const glm::uvec4 quads[6] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const glm::uvec4 q : quads) {
        mesh.triangles.emplace_back(q.x, q.y, q.z);
        mesh.triangles.emplace_back(q.x, q.z, q.w);
    }
    return mesh;
}

/// `mesh` with three vertices of its own for every triangle.
inline Mesh unwelded(const Mesh& mesh) {
    Mesh split;
    split.name = mesh.name;
    for (const glm::uvec3 t : mesh.triangles) {
        const auto first = static_cast<unsigned>(split.positions.size());
        for (int k = 0; k < 3; ++k) {
            split.positions.push_back(mesh.positions[t[k]]);
            if (!mesh.normals.empty()) split.normals.push_back(mesh.normals[t[k]]);
        }
        split.triangles.emplace_back(first, first + 1, first + 2);
    }
    return split;
}

/// Both meshes as one, without normals.
inline Mesh joined(const Mesh& a, const Mesh& b) {
    Mesh mesh = a;
    const auto first = static_cast<unsigned>(a.positions.size());
    mesh.positions.insert(mesh.positions.end(), b.positions.begin(), b.positions.end());
    for (const glm::uvec3 t : b.triangles) mesh.triangles.push_back(t + first);
    return mesh;
}

inline glm::vec3 face_normal(const Mesh& mesh, glm::uvec3 t) {
    return glm::normalize(
        glm::cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

}  // namespace pellucid::test
