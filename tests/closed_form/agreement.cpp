#include "closed_form/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid::test {
namespace {

constexpr double kCosDegree = 0.99984769515639123916;
constexpr double kShift_px = 0.1;
/// Distance by which the start of parallel rays may move, m: balls of triangles lie that much within true ones.
constexpr double kDepth = 2e-3;
/// Triangles change absorption and Fresnel reflectance by less.
constexpr double kTransmittance = 0.02;
constexpr int kShown = 5;

bool same_course(const closed_form::Path& a, const closed_form::Path& b) {
    const auto same = [](const closed_form::Event& x, const closed_form::Event& y) {
        return x.before == y.before && x.after == y.after && x.total == y.total;
    };
    return !a.cut && !b.cut && std::equal(a.events.begin(), a.events.end(), b.events.begin(), b.events.end(), same) &&
           glm::dot(a.direction, b.direction) > kCosDegree &&
           glm::all(glm::lessThan(glm::abs(a.transmittance - b.transmittance), glm::dvec3(kTransmittance)));
}

bool is_stable(const closed_form::Scene& scene, const closed_form::View& view, int size, glm::dvec2 center,
               const closed_form::Path& path) {
    for (const glm::dvec2 shift : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 1)}) {
        const closed_form::Ray ray = view.ray(center + kShift_px * shift, size);
        if (!same_course(path, scene.trace(ray, kMaxEvents))) return false;
    }
    if (!view.orthographic) return true;
    for (const double step : {-kDepth, kDepth}) {
        closed_form::Ray ray = view.ray(center, size);
        ray.origin += step * ray.direction;
        if (!same_course(path, scene.trace(ray, kMaxEvents))) return false;
    }
    return true;
}

bool is_right(const closed_form::Path& truth, const RefractedPath& path, Transmittance transmittance) {
    return path.status == Status::kOk && path.events == truth.events.size() &&
           path.reflections == truth.reflections() &&
           glm::dot(truth.direction, glm::normalize(glm::dvec3(path.direction))) > kCosDegree &&
           (transmittance == Transmittance::kIsFree ||
            glm::all(glm::lessThan(glm::abs(truth.transmittance - glm::dvec3(path.transmittance)),
                                   glm::dvec3(2.0 * kTransmittance))));
}

}  // namespace

Truth trace_closed_form(const closed_form::Scene& scene, const closed_form::View& view, int size) {
    Truth truth;
    truth.size = size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::dvec2 center(x + 0.5, y + 0.5);
            truth.paths.push_back(scene.trace(view.ray(center, size), kMaxEvents));
            truth.stable.push_back(is_stable(scene, view, size, center, truth.paths.back()) ? 1 : 0);
        }
    return truth;
}

Agreement agreement(const Truth& truth, std::span<const RefractedPath> paths, Transmittance transmittance) {
    Agreement result;
    int shown = 0;
    for (std::size_t i = 0; i < truth.paths.size(); ++i) {
        if (truth.stable[i] == 0 || (truth.paths[i].events.empty() && paths[i].events == 0)) continue;
        ++result.stable;
        if (is_right(truth.paths[i], paths[i], transmittance)) {
            ++result.right;
        } else if (shown++ < kShown) {
            result.wrong +=
                fmt::format("  pixel {}, {}\n    closed form {}\n    technique   {}\n", int(i) % truth.size,
                            int(i) / truth.size, closed_form::to_string(truth.paths[i]), to_string(paths[i]));
        }
    }
    return result;
}

std::string to_string(const RefractedPath& p) {
    return fmt::format(
        "{} events, {} reflections; out {:.4f} {:.4f} {:.4f} from ({:.3f} {:.3f} {:.3f}), "
        "T {:.3f} {:.3f} {:.3f}, {}",
        p.events, p.reflections, p.direction.x, p.direction.y, p.direction.z, p.position.x, p.position.y, p.position.z,
        p.transmittance.r, p.transmittance.g, p.transmittance.b, status_name(p.status));
}

}  // namespace pellucid::test
