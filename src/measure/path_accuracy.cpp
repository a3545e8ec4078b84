#include <pellucid/measure.h>

#include <pellucid/error.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

constexpr float kNotCovered = -1.0f;
constexpr float kWrong = 180.0f;

bool covered(const RefractedPath& path) { return path.events > 0; }

/// Angle between two directions, degrees. The arc cosine would lose half the digits of small angles.
float angle_deg(glm::dvec3 a, glm::dvec3 b) {
    const double across = glm::length(glm::cross(a, b)), along = glm::dot(a, b);
    const double angle = std::atan2(across, along) * (180.0 / std::numbers::pi);
    const bool both_directions = glm::dot(a, a) > 0.0 && glm::dot(b, b) > 0.0 && std::isfinite(angle);
    return both_directions ? float(angle) : kWrong;
}

bool same_end(const RefractedPath& exact, const RefractedPath& candidate, const PixelFootprint& footprint) {
    const float tolerance = footprint.at_eye + footprint.per_metre * exact.length;
    return candidate.object == exact.object && glm::distance(candidate.position, exact.position) <= tolerance;
}

/// Counts the right pixels of a group.
struct Count {
    std::uint64_t all = 0, right = 0;

    void add(bool is_right) {
        ++all;
        right += is_right ? 1 : 0;
    }
    double share_of(std::uint64_t whole) const { return whole > 0 ? double(all) / double(whole) : 0.0; }
    double share_right() const { return all > 0 ? double(right) / double(all) : 1.0; }
    GroupAccuracy accuracy(std::uint64_t whole) const { return {share_of(whole), share_right()}; }
};

void check_sizes(std::size_t pixels, std::span<const RefractedPath> exact, std::span<const RefractedPath> candidate) {
    if (exact.size() != pixels || candidate.size() != pixels) {
        throw Error(fmt::format("{} exact and {} other paths for {} pixels", exact.size(), candidate.size(), pixels));
    }
}

}  // namespace

float path_error_deg(const RefractedPath& exact, const RefractedPath& candidate, const PixelFootprint& footprint) {
    if (!covered(exact)) return kNotCovered;
    // If the exact path is cut after K events, a candidate cut at the same event agrees with it.
    const bool both_cut = exact.status == Status::kEventLimit && candidate.status == Status::kEventLimit &&
                          candidate.events == exact.events;
    if (!covered(candidate) || (candidate.status != Status::kOk && !both_cut)) return kWrong;
    if (exact.object >= 0) return same_end(exact, candidate, footprint) ? 0.0f : kWrong;
    if (candidate.object >= 0) return kWrong;
    return angle_deg(exact.direction, candidate.direction);
}

Image path_error_image(int width, int height, std::span<const RefractedPath> exact,
                       std::span<const RefractedPath> candidate, const PixelFootprint& footprint) {
    Image image(width, height, 1);
    check_sizes(image.pixels.size(), exact, candidate);
    for (std::size_t i = 0; i < exact.size(); ++i) image.pixels[i] = path_error_deg(exact[i], candidate[i], footprint);
    return image;
}

PathAccuracy path_accuracy(std::span<const RefractedPath> exact, std::span<const RefractedPath> candidate,
                           const Image& error_deg, std::span<const std::uint8_t> stable) {
    check_sizes(error_deg.pixels.size(), exact, candidate);
    if (stable.size() != exact.size())
        throw Error(fmt::format("{} pixels stable or not of {}", stable.size(), exact.size()));
    Count within_1, within_5, stable_ones, two, four, more, tir;
    std::array<std::uint64_t, kStatusCount> status{};
    std::vector<double> errors;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (!covered(exact[i])) continue;
        const float error = error_deg.pixels[i];
        const bool right = error < 1.0f;
        errors.push_back(double(error));
        within_1.add(right);
        within_5.add(error < 5.0f);
        if (stable[i] != 0) stable_ones.add(right);
        (exact[i].events <= 2 ? two : exact[i].events <= 4 ? four : more).add(right);
        if (exact[i].reflections > 0) tir.add(right);
        ++status.at(std::size_t(candidate[i].status));
    }
    PathAccuracy result;
    result.covered = within_1.all;
    if (result.covered == 0) return result;
    const Spread of_errors = spread(std::move(errors));
    result.within_1deg = within_1.share_right();
    result.within_5deg = within_5.share_right();
    result.stable_share = stable_ones.share_of(result.covered);
    result.within_1deg_stable = stable_ones.share_right();
    result.median_deg = of_errors.median;
    result.p95_deg = of_errors.p95;
    for (std::size_t i = 0; i < status.size(); ++i) result.status[i] = double(status[i]) / double(result.covered);
    result.two_events = two.accuracy(result.covered);
    result.four_events = four.accuracy(result.covered);
    result.more_events = more.accuracy(result.covered);
    result.with_tir = tir.accuracy(result.covered);
    return result;
}

}  // namespace pellucid
