#include "closed_form/solid_file.h"

#include "unit/built_scenes.h"

#include <algorithm>

#include <cmath>
#include <map>
#include <utility>

namespace pellucid::test {
namespace {

/// Faces of an icosahedron with their vertices on the unit ball.
struct Sphere {
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;
};

Sphere icosahedron() {
    const double g = (1.0 + std::sqrt(5.0)) / 2.0;
    Sphere s;
    s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (glm::dvec3& p : s.points) p = glm::normalize(p);
    s.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    return s;
}

void halve_edges(Sphere& s) {
    std::map<std::pair<unsigned, unsigned>, unsigned> middles;
    const auto middle = [&](unsigned a, unsigned b) {
        const auto [at, added] = middles.try_emplace(std::minmax(a, b), unsigned(s.points.size()));
        if (added) s.points.push_back(glm::normalize(s.points[a] + s.points[b]));
        return at->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3 t : s.triangles) {
        const unsigned a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
        finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    s.triangles = std::move(finer);
}

}  // namespace

Mesh ball_mesh(int levels) {
    Sphere s = icosahedron();
    for (int level = 0; level < levels; ++level) halve_edges(s);
    Mesh mesh;
    mesh.name = "ball";
    mesh.positions.assign(s.points.begin(), s.points.end());
    mesh.normals = mesh.positions;
    mesh.triangles = std::move(s.triangles);
    return mesh;
}

Mesh box_mesh() {
    Mesh mesh;
    mesh.name = "box";
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const float side = face % 2 == 0 ? -1.0f : 1.0f;
        const auto first = unsigned(mesh.positions.size());
        for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
            glm::vec3 p, n(0.0f);
            p[axis] = n[axis] = side;
            p[(axis + 1) % 3] = side * corner.x;  // the face's other two axes, counter-clockwise from outside
            p[(axis + 2) % 3] = corner.y;
            mesh.positions.push_back(p);
            mesh.normals.push_back(n);
        }
        mesh.triangles.emplace_back(first, first + 1, first + 2);
        mesh.triangles.emplace_back(first, first + 2, first + 3);
    }
    return mesh;
}

Mesh moved(const Mesh& mesh, const glm::dmat4& to_from) {
    Mesh result = mesh;
    const glm::dmat3 linear(to_from), normals = glm::transpose(glm::inverse(linear));
    for (glm::vec3& p : result.positions) p = glm::vec3(to_from * glm::dvec4(glm::dvec3(p), 1.0));
    for (glm::vec3& n : result.normals) n = glm::vec3(glm::normalize(normals * glm::dvec3(n)));
    if (glm::determinant(linear) < 0.0)
        for (glm::uvec3& t : result.triangles) std::swap(t.y, t.z);
    return result;
}

Mesh shell_mesh(const closed_form::Shell& shell, int ball_levels) {
    // Rounding comes once, after the transform: shells at one place in two files agree to the last bits.
    static std::map<int, Mesh> balls;
    if (!balls.contains(ball_levels)) balls[ball_levels] = ball_mesh(ball_levels);
    const bool ball = shell.kind == closed_form::ShellKind::kBall;
    Mesh mesh = moved(ball ? balls[ball_levels] : box_mesh(), shell.world_from_shell);
    return shell.winding < 0 ? inside_out(std::move(mesh)) : mesh;
}

std::optional<Mesh> bridged_shells(const closed_form::Shell& a, const closed_form::Shell& b, int ball_levels) {
    Mesh mesh = shell_mesh(a, ball_levels), other = shell_mesh(b, ball_levels);
    const auto take = [](Mesh& from, const closed_form::Shell& inside) -> std::optional<glm::uvec3> {
        const auto found = std::find_if(from.triangles.begin(), from.triangles.end(), [&](const glm::uvec3& t) {
            return closed_form::contains(inside, from.positions[t.x]) &&
                   closed_form::contains(inside, from.positions[t.y]) &&
                   closed_form::contains(inside, from.positions[t.z]);
        });
        if (found == from.triangles.end()) return std::nullopt;
        const glm::uvec3 taken = *found;
        from.triangles.erase(found);
        return taken;
    };
    const std::optional<glm::uvec3> hole = take(mesh, b), other_hole = take(other, a);
    if (!hole || !other_hole) return std::nullopt;
    const glm::uvec3 end = glm::uvec3(other_hole->x, other_hole->z, other_hole->y) + unsigned(mesh.positions.size());
    append(mesh, other);
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        mesh.triangles.emplace_back((*hole)[k], (*hole)[next], end[next]);
        mesh.triangles.emplace_back((*hole)[k], end[next], end[k]);
    }
    return mesh;
}

void append(Mesh& mesh, const Mesh& more) {
    const auto first = unsigned(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    mesh.normals.insert(mesh.normals.end(), more.normals.begin(), more.normals.end());
    for (const glm::uvec3 t : more.triangles) mesh.triangles.push_back(t + first);
}

Mesh double_sided(const Mesh& mesh) {
    Mesh both = mesh;
    append(both, inside_out(mesh));
    return both;
}

std::vector<Mesh> split(const Mesh& mesh, int count) {
    std::vector<Mesh> parts(static_cast<std::size_t>(count));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const std::size_t all = mesh.triangles.size();
        std::map<unsigned, unsigned> renamed;
        for (std::size_t t = k * all / parts.size(); t < (k + 1) * all / parts.size(); ++t) {
            glm::uvec3 triangle;
            for (int c = 0; c < 3; ++c) {
                const unsigned v = mesh.triangles[t][c];
                const auto [at, added] = renamed.try_emplace(v, unsigned(renamed.size()));
                if (added) {
                    parts[k].positions.push_back(mesh.positions[v]);
                    parts[k].normals.push_back(mesh.normals[v]);
                }
                triangle[c] = at->second;
            }
            parts[k].triangles.push_back(triangle);
        }
    }
    return parts;
}

int SolidFile::material(const closed_form::Medium& medium, double roughness) {
    // What is left after a distance on which some is.
    const double most = std::max({medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b});
    const double distance = most > 0.0 ? 1.0 / most : 1.0;
    const glm::dvec3 color = glm::exp(-medium.sigma_a * distance);
    return material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
                     {"extensions",
                      {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                       {"KHR_materials_ior", {{"ior", medium.ior}}},
                       {"KHR_materials_volume",
                        {{"thicknessFactor", 1},
                         {"attenuationColor", {color.r, color.g, color.b}},
                         {"attenuationDistance", distance}}}}}});
}

int SolidFile::material(json material) {
    json& all = builder_.root["materials"];
    material["name"] = "material " + std::to_string(all.size());
    all.push_back(std::move(material));
    return int(all.size()) - 1;
}

int SolidFile::mesh(const std::vector<Mesh>& primitives, const std::vector<int>& materials) {
    json list = json::array();
    for (std::size_t k = 0; k < primitives.size(); ++k) {
        const Mesh& mesh = primitives[k];
        const auto floats = [&](const std::vector<glm::vec3>& from) {
            std::vector<float> values;
            for (const glm::vec3& v : from) values.insert(values.end(), {v.x, v.y, v.z});
            return builder_.attribute(values, kFloat, "VEC3", 3);
        };
        std::vector<std::uint32_t> indices;
        for (const glm::uvec3& t : mesh.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
        json attributes = {{"POSITION", floats(mesh.positions)}};
        if (!mesh.normals.empty()) attributes["NORMAL"] = floats(mesh.normals);
        const int index = builder_.attribute(indices, kUnsignedInt, "SCALAR", 1);
        list.push_back({{"attributes", attributes}, {"indices", index}, {"material", materials[k]}});
    }
    json& all = builder_.root["meshes"];
    all.push_back({{"name", "mesh " + std::to_string(all.size())}, {"primitives", list}});
    return int(all.size()) - 1;
}

void SolidFile::node(int mesh, const glm::dmat4& world_from_mesh, int priority) {
    json matrix = json::array();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) matrix.push_back(world_from_mesh[c][r]);
    json node = {{"mesh", mesh}, {"matrix", matrix}, {"name", "node " + std::to_string(nodes_++)}};
    if (priority != 0) node["extras"] = {{"pellucid", {{"priority", priority}}}};
    builder_.node(std::move(node));
}

void SolidFile::camera(const closed_form::View& view) {
    json matrix = json::array();
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) matrix.push_back(view.world_from_view[c][r]);
    json camera = {{"type", view.orthographic ? "orthographic" : "perspective"}};
    const double half = 0.5 * view.vertical_extent;
    if (view.orthographic) {
        camera["orthographic"] = {{"xmag", half}, {"ymag", half}, {"znear", 0}, {"zfar", 1e6}};
    } else {
        camera["perspective"] = {{"yfov", view.vertical_fov}, {"znear", 1e-3}};
    }
    builder_.root["cameras"].push_back(camera);
    builder_.node({{"camera", int(builder_.root["cameras"].size()) - 1}, {"matrix", matrix}});
    ++nodes_;
}

std::string SolidFile::write(const TemporaryFolder& folder) {
    json nodes = json::array();
    for (std::size_t i = 0; i < builder_.root["nodes"].size(); ++i) nodes.push_back(i);
    builder_.root["scenes"][0]["nodes"] = nodes;
    builder_.root["extensionsUsed"] = {"KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_unlit",
                                       "KHR_materials_volume"};
    return builder_.glb(folder);
}

Scene SolidFile::load(const LoadOptions& options) {
    const TemporaryFolder folder;
    return load_scene(write(folder), options);
}

Camera camera_of(const closed_form::View& view) {
    Camera camera;
    camera.world_from_view = glm::mat4(view.world_from_view);
    camera.orthographic = view.orthographic;
    camera.vertical_fov = float(view.vertical_fov);
    camera.vertical_extent = view.orthographic ? float(view.vertical_extent) : 0.0f;
    return camera;
}

closed_form::View view_of(const Camera& camera) {
    closed_form::View view;
    view.world_from_view = glm::dmat4(camera.world_from_view);
    view.orthographic = camera.orthographic;
    view.vertical_fov = double(camera.vertical_fov);
    view.vertical_extent = double(camera.vertical_extent);
    return view;
}

}  // namespace pellucid::test
