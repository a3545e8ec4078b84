#include "lab/accuracy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pellucid::cli {
namespace {

PixelFootprint pixel_footprint(const Camera& camera, std::uint32_t height) {
    if (camera.orthographic) return {.at_eye = camera.vertical_extent / float(height), .per_metre = 0.0f};
    return {.at_eye = 0.0f, .per_metre = 2.0f * std::tan(0.5f * camera.vertical_fov) / float(height)};
}

constexpr double kStabilityShift = 0.1;  // px
constexpr glm::dvec2 kStabilityShifts[] = {
    {kStabilityShift, 0.0}, {-kStabilityShift, 0.0}, {0.0, kStabilityShift}, {0.0, -kStabilityShift}};
constexpr glm::dvec2 kSelfShift{0.0001, 0.0};  // px

}  // namespace

Camera OrbitView::camera(const Bounds& bounds) const {
    return orbit_camera(bounds, azimuth_deg, elevation_deg, distance, Camera{}.vertical_fov);
}

std::string OrbitView::description() const {
    return fmt::format("orbit:{},{},{}", azimuth_deg, elevation_deg, distance);
}

OrbitView comparison_view(const Bounds& bounds, int index, int count, std::uint32_t width, std::uint32_t height) {
    constexpr float kShare = 0.7f, kElevationDeg = 15.0f;
    const float share = kShare * std::min(1.0f, float(width) / float(height));
    const float largest = std::max({bounds.half_size.x, bounds.half_size.y, bounds.half_size.z});
    const float distance = framing_distance(Camera{}.vertical_fov, share) * largest / bounds.radius;
    return {360.0f * float(index) / float(count), kElevationDeg, distance};
}

ExactView trace_exact_view(const Tracer& tracer, const Camera& camera, std::uint32_t width, std::uint32_t height,
                           std::uint32_t max_events, const Progress& progress) {
    int traced = 0;
    const auto trace = [&](glm::dvec2 shift) {
        const auto part = [&](double share) {
            constexpr double kTraces = 2.0 + double(std::size(kStabilityShifts));
            if (progress) progress((traced + share) / kTraces);
        };
        std::vector<RefractedPath> paths =
            tracer.exact(camera, {.width = width, .height = height, .max_events = max_events, .shift_px = shift}, part);
        ++traced;
        return paths;
    };
    ExactView view;
    view.width = width;
    view.height = height;
    view.footprint = pixel_footprint(camera, height);
    view.paths = trace({});
    view.covered.resize(view.paths.size());
    for (std::size_t i = 0; i < view.paths.size(); ++i) view.covered[i] = view.paths[i].events > 0 ? 1 : 0;

    view.stable = view.covered;
    for (const glm::dvec2 shift : kStabilityShifts) {
        const std::vector<RefractedPath> shifted = trace(shift);
        for (std::size_t i = 0; i < shifted.size(); ++i) {
            if (view.stable[i] != 0 && !(path_error_deg(view.paths[i], shifted[i], view.footprint) < 1.0f))
                view.stable[i] = 0;
        }
    }
    view.self_within_1deg = judge(view, trace(kSelfShift)).accuracy.within_1deg;
    return view;
}

Judgement judge(const ExactView& exact, const std::vector<RefractedPath>& paths) {
    Judgement judgement;
    judgement.error_deg = path_error_image(int(exact.width), int(exact.height), exact.paths, paths, exact.footprint);
    judgement.accuracy = path_accuracy(exact.paths, paths, judgement.error_deg, exact.stable);
    return judgement;
}

void add_accuracy(nlohmann::ordered_json& run, const ExactView& exact, const PathAccuracy& accuracy) {
    // A share of no pixels is null.
    const auto known = [](bool any, double value) { return any ? nlohmann::ordered_json(value) : nullptr; };
    const bool any = accuracy.covered > 0;
    run["covered"] = accuracy.covered;
    run["stable_share"] = known(any, accuracy.stable_share);
    run["self_within_1deg"] = known(any, exact.self_within_1deg);
    run["within_1deg"] = known(any, accuracy.within_1deg);
    run["within_5deg"] = known(any, accuracy.within_5deg);
    run["within_1deg_stable"] = known(any && accuracy.stable_share > 0.0, accuracy.within_1deg_stable);
    run["median_deg"] = known(any, accuracy.median_deg);
    run["p95_deg"] = known(any, accuracy.p95_deg);
    for (std::uint32_t status = 0; status < kStatusCount; ++status)
        run["status"][std::string(status_name(Status(status)))] = accuracy.status[status];
    const auto group = [](const GroupAccuracy& g) {
        return nlohmann::ordered_json{{"share", g.share}, {"within_1deg", g.within_1deg}};
    };
    run["by_events"] = {{"2", group(accuracy.two_events)},
                        {"4", group(accuracy.four_events)},
                        {"more", group(accuracy.more_events)},
                        {"tir", group(accuracy.with_tir)}};
}

}  // namespace pellucid::cli
