#include "closed_form/arrangement.h"

#include "closed_form/random_solids.h"
#include "unit/built_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace pellucid::test {
namespace {

using closed_form::Shell;
using closed_form::ShellKind;
using closed_form::View;

constexpr double kClearance = 0.05;  // of the eye from any surface, m

/// True if no surface is near the point, as far as 26 directions tell.
bool clear_of_surfaces(const closed_form::Scene& scene, const glm::dvec3& eye) {
    const std::vector<int> here = scene.windings(eye);
    for (int k = 0; k < 27; ++k) {
        const glm::dvec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if (k != 13 && scene.windings(eye + kClearance * glm::normalize(step)) != here) return false;
    }
    return true;
}

glm::dmat4 looking(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& up_hint) {
    const glm::dvec3 z = -glm::normalize(direction);
    const glm::dvec3 x = glm::normalize(glm::cross(up_hint, z));
    return {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), glm::dvec4(eye, 1)};
}

/// Towards one of the solids from outside or from anywhere within, a solid too; in parallel, the image plane anywhere.
View random_view(Random& random, const closed_form::Scene& scene, bool tidy) {
    const std::vector<Shell>& aim = scene.bodies()[random.below(std::uint32_t(scene.bodies().size()))].shells;
    const glm::dvec3 target(aim.front().world_from_shell[3]);
    View view;
    view.orthographic = random.chance(tidy ? 0.5 : 0.25);
    const bool within = random.chance(0.4);
    view.vertical_fov = random.between(within ? 0.7 : 0.4, within ? 1.5 : 0.7);
    view.vertical_extent = random.between(2.0, 3.5);
    for (int attempt = 0;; ++attempt) {
        const glm::dvec3 eye = within ? 0.8 * random.in_ball() : target + random.between(2.0, 4.0) * random.direction();
        glm::dvec3 ahead = target + (within ? 0.6 : 0.2) * random.in_ball() - eye;
        glm::dmat4 placed = looking(eye, ahead, random.direction());
        if (tidy && view.orthographic) {
            // Straight along an axis, the image's centre on it.
            placed = glm::dmat4(random.quarter_turns());
            placed[3] = glm::dvec4((within ? 0.3 : 4.0) * glm::dvec3(placed[2]), 1.0);
        }
        view.world_from_view = glm::dmat4(glm::mat4(placed));  // as the file's readers will have it
        if (view.orthographic || attempt > 200 || clear_of_surfaces(scene, glm::dvec3(placed[3]))) return view;
    }
}

/// Volumes that decide which solid wins are clearly apart, or equal by construction.
bool volumes_decide(const std::vector<PlannedSolid>& solids, const PlannedSolid& added) {
    return std::none_of(solids.begin(), solids.end(), [&](const PlannedSolid& other) {
        if (other.priority != added.priority) return false;
        const double difference = std::abs(other.volume - added.volume) / std::max(other.volume, added.volume);
        return difference > 1e-6 && difference < 0.02;
    });
}

/// Joins the first two shells of some solids whose file has nothing else to repair there.
void bridge_some(Random& random, std::vector<PlannedSolid>& solids) {
    for (PlannedSolid& solid : solids) {
        if (solid.mesh_of >= 0 || solid.double_sided || solid.miswound || solid.shells.size() < 2) continue;
        const PlannedShell &a = solid.shells[0], &b = solid.shells[1];
        const auto plain = [](const PlannedShell& s) {
            return s.shell.winding > 0 && !s.written_inside_out && !s.written_twice;
        };
        if (plain(a) && plain(b) && random.chance(0.5)) solid.bridged = bridged_shells(a.shell, b.shell).has_value();
    }
}

Mesh written_shell(const PlannedShell& planned, const PlannedSolid& solid, int ball_levels) {
    Mesh mesh = shell_mesh(planned.shell, ball_levels);
    if (planned.written_inside_out) mesh = inside_out(std::move(mesh));
    if (solid.miswound) {
        // Both triangles of a box's face, a third of a ball's: never all, never none.
        const bool box = planned.shell.kind == ShellKind::kBox;
        mesh = miswound(std::move(mesh), [&](std::size_t t) { return (box ? t / 2 : t / 7) % 3 == 1; });
    }
    if (planned.written_twice) append(mesh, Mesh(mesh));
    return solid.double_sided ? double_sided(mesh) : mesh;
}

}  // namespace

Arrangement make_arrangement(std::uint32_t seed) {
    Random random(seed);
    Arrangement result;
    result.seed = seed;
    const bool single = seed % 5 == 0;
    const bool tidy = !single && random.chance(0.15);
    const int count = single ? 1 : 2 + int(random.below(6));
    for (int attempt = 0; attempt < 1000 && int(result.solids.size()) < count; ++attempt) {
        SolidChooser chooser(random, result.solids, tidy, single);
        const std::optional<PlannedSolid> solid = chooser.choose();
        if (solid && volumes_decide(result.solids, *solid)) result.solids.push_back(*solid);
    }
    result.view = random_view(random, closed_form_scene(result), tidy);
    Random bridges(~std::uint64_t(seed));
    bridge_some(bridges, result.solids);
    return result;
}

closed_form::Scene closed_form_scene(const Arrangement& arrangement) {
    std::vector<closed_form::Body> bodies;
    for (const PlannedSolid& solid : arrangement.solids) {
        closed_form::Body body{{}, solid.medium, solid.priority, solid.volume};
        for (const PlannedShell& planned : solid.shells) {
            Shell shell = planned.shell;
            shell.world_from_shell = glm::dmat4(solid.world_from_solid) * shell.world_from_shell;
            body.shells.push_back(shell);
        }
        bodies.push_back(std::move(body));
    }
    return closed_form::Scene(std::move(bodies));
}

SolidFile solid_file(const Arrangement& arrangement, int ball_levels) {
    SolidFile file;
    std::vector<int> meshes;
    for (const PlannedSolid& solid : arrangement.solids) {
        if (solid.mesh_of >= 0) {
            meshes.push_back(meshes[std::size_t(solid.mesh_of)]);
        } else {
            Mesh mesh;
            if (solid.bridged) mesh = bridged_shells(solid.shells[0].shell, solid.shells[1].shell, ball_levels).value();
            for (std::size_t k = solid.bridged ? 2 : 0; k < solid.shells.size(); ++k)
                append(mesh, written_shell(solid.shells[k], solid, ball_levels));
            std::vector<int> materials;
            for (int k = 0; k < solid.primitives; ++k) materials.push_back(file.material(solid.medium));
            meshes.push_back(file.mesh(split(mesh, solid.primitives), materials));
        }
        file.node(meshes.back(), glm::dmat4(solid.world_from_solid), solid.priority);
    }
    file.camera(arrangement.view);
    return file;
}

Arrangement written_plainly(Arrangement arrangement) {
    for (PlannedSolid& solid : arrangement.solids) {
        solid.primitives = 1;
        solid.double_sided = solid.miswound = solid.bridged = false;
        for (PlannedShell& shell : solid.shells) shell.written_inside_out = shell.written_twice = false;
    }
    return arrangement;
}

std::string describe(const Arrangement& arrangement) {
    const View& view = arrangement.view;
    const glm::dvec3 eye(view.world_from_view[3]), ahead(-view.world_from_view[2]);
    std::string text = fmt::format(
        "arrangement {}: {} from ({:.4f} {:.4f} {:.4f}) along ({:.4f} {:.4f} {:.4f}), {} {:.4f}\n", arrangement.seed,
        view.orthographic ? "orthographic" : "perspective", eye.x, eye.y, eye.z, ahead.x, ahead.y, ahead.z,
        view.orthographic ? "height" : "field of view", view.orthographic ? view.vertical_extent : view.vertical_fov);
    const closed_form::Scene scene = closed_form_scene(arrangement);
    if (!view.orthographic) text += fmt::format("the eye is in {}\n", scene.body_at(eye));
    for (std::size_t i = 0; i < arrangement.solids.size(); ++i) {
        const PlannedSolid& s = arrangement.solids[i];
        const glm::dvec3 sigma = s.medium.sigma_a;
        text +=
            fmt::format("{}: {}; n {:.3f}, sigma {:.2f} {:.2f} {:.2f}, priority {}, {:.5f} m3, {} primitives{}{}{}{}\n",
                        i, s.story, s.medium.ior, sigma.r, sigma.g, sigma.b, s.priority, s.volume, s.primitives,
                        s.double_sided ? ", double-sided" : "",
                        s.miswound  ? ", miswound"
                        : s.bridged ? ", the first two shells joined"
                                    : "",
                        glm::determinant(glm::mat3(s.world_from_solid)) < 0.0f ? ", mirrored" : "",
                        s.mesh_of >= 0 ? fmt::format(", instance of {}", s.mesh_of) : "");
        for (std::size_t k = 0; k < s.shells.size(); ++k) {
            const Shell& shell = scene.bodies()[i].shells[k];
            const glm::dvec3 c(shell.world_from_shell[3]), h = closed_form::half_box(shell);
            text += fmt::format("   {} at ({:.4f} {:.4f} {:.4f}), half box ({:.4f} {:.4f} {:.4f}){}{}{}\n",
                                shell.kind == ShellKind::kBall ? "ball" : "box", c.x, c.y, c.z, h.x, h.y, h.z,
                                shell.winding < 0 ? ", cavity" : "",
                                s.shells[k].written_inside_out ? ", inside out in the file" : "",
                                s.shells[k].written_twice ? ", twice in the file" : "");
        }
    }
    return text;
}

}  // namespace pellucid::test
