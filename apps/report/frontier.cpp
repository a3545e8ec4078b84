#include "report/frontier.h"

#include <pellucid/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

namespace pellucid {
namespace {

// Pixels of the drawing.
constexpr double kWidth = 560.0;
constexpr double kLeft = 58.0;
constexpr double kRight = 544.0;
constexpr double kTop = 40.0;
constexpr double kBottom = 310.0;
constexpr double kLegendTop = 378.0;
constexpr double kLegendRow = 22.0;

constexpr double kGreatestAccuracy = 0.9999;  ///< end of the axis: 100% would be infinitely far up
constexpr std::array kAccuracyTicks = {0.0, 0.5, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.998, 0.999, kGreatestAccuracy};

/// Colours of equal lightness, with enough contrast on white and on black. Techniques also differ in the shape of
/// their marks.
constexpr std::array kColors = {"#3284d0", "#cb6620", "#2d9570", "#c74c8e", "#9d8519", "#8362cd"};
/// Outlines about (0, 0), of radius about 1: disc, square, triangle, diamond, star.
constexpr std::array kMarks = {
    "M-1 0A1 1 0 1 1 1 0A1 1 0 1 1-1 0Z",
    "M-.9-.9H.9V.9H-.9Z",
    "M0-1.2L1.1.8H-1.1Z",
    "M0-1.3L1.3 0 0 1.3-1.3 0Z",
    "M0-1.4L.4-.4 1.4 0 .4.4 0 1.4-.4.4-1.4 0-.4-.4Z",
};

/// All selectors begin with the class of the root, so that they do not affect other drawings of the page.
constexpr const char* kStyle = R"(<style>
.frontier{font:13px system-ui,sans-serif;--ink:#1d2125;--soft:#59626b;--rule:#dde1e5;fill:var(--ink)}
.frontier .grid{stroke:var(--rule)}
.frontier .soft{fill:var(--soft)}
.frontier .line{fill:none;stroke:var(--soft);stroke-width:1.5;stroke-dasharray:5 4}
.frontier .run{opacity:.45}
.frontier .end{text-anchor:end}
.frontier .middle{text-anchor:middle}
@media (prefers-color-scheme:dark){.frontier{--ink:#e3e6e9;--soft:#a3acb5;--rule:#31373d}}
</style>
)";

/// Escapes a name as XML text. Removes control characters, which XML forbids even as escapes.
std::string xml_text(const std::string& name) {
    std::string text;
    for (const char c : one_line(name)) {
        if (c == '&')
            text += "&amp;";
        else if (c == '<')
            text += "&lt;";
        else if (c == '>')
            text += "&gt;";
        else
            text += c;
    }
    return text;
}

/// Decades of reduction of wrong pixels: 0 for 0%, 1 for 90%, 2 for 99%.
double nines(double accuracy) { return -std::log10(1.0 - std::clamp(accuracy, 0.0, kGreatestAccuracy)); }

/// Map from measured values to pixels.
struct Axes {
    double least_ms, greatest_ms;
    double least_accuracy, greatest_accuracy;

    double x(double time_ms) const {
        return std::lerp(kLeft, kRight, std::log(time_ms / least_ms) / std::log(greatest_ms / least_ms));
    }
    double y(double accuracy) const {
        const double low = nines(least_accuracy);
        return std::lerp(kBottom, kTop, (nines(accuracy) - low) / (nines(greatest_accuracy) - low));
    }
};

/// Axes that contain all points: times with a margin for a tick on both sides, accuracies from tick to tick.
Axes fitting_axes(const std::vector<Performance>& points) {
    const auto [fastest, slowest] = std::minmax_element(
        points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time_ms < b.time_ms; });
    const auto [worst, best] = std::minmax_element(
        points.begin(), points.end(), [](const auto& a, const auto& b) { return a.accuracy < b.accuracy; });
    // Two margins of factor 1.6 exceed the widest step between ticks, from 2 to 5, so there is always a tick.
    Axes axes{fastest->time_ms / 1.6, slowest->time_ms * 1.6, 0.0, kGreatestAccuracy};
    const auto above = std::lower_bound(kAccuracyTicks.begin() + 1, kAccuracyTicks.end() - 1, best->accuracy);
    axes.greatest_accuracy = *above;
    const auto below = std::upper_bound(kAccuracyTicks.begin() + 1, above, worst->accuracy);
    axes.least_accuracy = *std::prev(below);
    return axes;
}

std::string time_ticks(const Axes& axes) {
    const bool wide = axes.greatest_ms / axes.least_ms > 1000.0;
    std::string svg;
    for (int decade = int(std::floor(std::log10(axes.least_ms))); decade <= std::log10(axes.greatest_ms); ++decade) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double time_ms = digit * std::pow(10.0, decade);
            if (time_ms < axes.least_ms || time_ms > axes.greatest_ms || (wide && digit != 1.0)) continue;
            const double x = axes.x(time_ms);
            svg += fmt::format(
                "<path class='grid' d='M{0:.1f} {1}V{2}'/><text class='soft middle' x='{0:.1f}' y='{3}'>"
                "{4:.4g}</text>\n",
                x, kTop, kBottom, kBottom + 18.0, time_ms);
        }
    }
    return svg + fmt::format("<text class='soft end' x='{}' y='{}'>time of a frame, ms</text>\n", kRight, kBottom + 38);
}

std::string accuracy_ticks(const Axes& axes, const std::string& accuracy_name) {
    std::string svg =
        fmt::format("<text class='soft' x='0' y='16'>{}, % (its distance from 100 is logarithmic)</text>\n",
                    xml_text(accuracy_name));
    for (const double accuracy : kAccuracyTicks) {
        if (accuracy < axes.least_accuracy || accuracy > axes.greatest_accuracy) continue;
        const double y = axes.y(accuracy);
        svg += fmt::format(
            "<path class='grid' d='M{} {:.1f}H{}'/><text class='soft end' x='{}' y='{:.1f}'>{:.4g}</text>\n", kLeft, y,
            kRight, kLeft - 8.0, y + 4.5, 100.0 * accuracy);
    }
    return svg;
}

std::string mark(std::size_t technique, double x, double y, double radius, const char* css_class) {
    return fmt::format("<path class='{}' fill='{}' transform='translate({:.1f} {:.1f}) scale({})' d='{}'/>\n",
                       css_class, kColors[technique % kColors.size()], x, y, radius, kMarks[technique % kMarks.size()]);
}

/// Staircase through the best means: no mean lies left of and above the line.
std::string frontier_line(const Axes& axes, const std::vector<Performance>& means) {
    const std::vector<std::size_t> best = pareto_frontier(means);
    std::string path = fmt::format("M{:.1f} {}V{:.1f}", axes.x(means[best.front()].time_ms), kBottom,
                                   axes.y(means[best.front()].accuracy));
    for (const std::size_t i : best)
        path += fmt::format("H{:.1f}V{:.1f}", axes.x(means[i].time_ms), axes.y(means[i].accuracy));
    return fmt::format("<path class='line' d='{}H{}'/>\n", path, kRight);
}

std::string legend_row(std::size_t technique, double y, const TechniquePerformance& of) {
    const std::string name = fmt::format("<text x='{}' y='{}'>{}</text>", kLeft + 14.0, y + 4.5, xml_text(of.name));
    const std::optional<Performance> mean = of.mean();
    if (!mean) {
        return fmt::format("{}<text class='soft end' x='{}' y='{}'>no time known</text>\n", name, kRight, y + 4.5);
    }
    return mark(technique, kLeft, y, 5.0, "mean") + name +
           fmt::format(
               "<text class='end' x='{}' y='{}'>{:.4g} ms</text><text class='end' x='{}' y='{}'>{:.2f}%</text>\n",
               kRight - 84.0, y + 4.5, mean->time_ms, kRight, y + 4.5, 100.0 * mean->accuracy);
}

bool has_no_time(const TechniquePerformance& technique) { return technique.runs.empty(); }

/// All marks; means are drawn over runs.
std::string marks(const Axes& axes, const std::vector<TechniquePerformance>& techniques) {
    std::string runs, means;
    for (std::size_t i = 0; i < techniques.size(); ++i) {
        if (has_no_time(techniques[i])) continue;
        for (const Performance& run : techniques[i].runs)
            runs += mark(i, axes.x(run.time_ms), axes.y(run.accuracy), 2.6, "run");
        const Performance mean = *techniques[i].mean();
        means += mark(i, axes.x(mean.time_ms), axes.y(mean.accuracy), 6.0, "mean");
    }
    return runs + means;
}

}  // namespace

std::optional<Performance> TechniquePerformance::mean() const {
    if (runs.empty()) return std::nullopt;
    const auto add = [](const Performance& a, const Performance& b) {
        return Performance{a.time_ms + b.time_ms, a.accuracy + b.accuracy};
    };
    const Performance sum = std::accumulate(runs.begin(), runs.end(), Performance{}, add);
    return Performance{sum.time_ms / double(runs.size()), sum.accuracy / double(runs.size())};
}

std::vector<std::size_t> pareto_frontier(const std::vector<Performance>& candidates) {
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (candidates[a].time_ms != candidates[b].time_ms) return candidates[a].time_ms < candidates[b].time_ms;
        return candidates[a].accuracy > candidates[b].accuracy;
    });
    std::vector<std::size_t> frontier;
    for (const std::size_t i : order) {
        const bool equal = !frontier.empty() && candidates[frontier.back()].time_ms == candidates[i].time_ms &&
                           candidates[frontier.back()].accuracy == candidates[i].accuracy;
        if (frontier.empty() || equal || candidates[i].accuracy > candidates[frontier.back()].accuracy)
            frontier.push_back(i);
    }
    return frontier;
}

std::string frontier_svg(const std::vector<TechniquePerformance>& techniques, const std::string& accuracy_name) {
    if (std::all_of(techniques.begin(), techniques.end(), has_no_time)) return {};
    std::vector<Performance> points, means;
    for (const TechniquePerformance& technique : techniques) {
        points.insert(points.end(), technique.runs.begin(), technique.runs.end());
        if (const std::optional<Performance> mean = technique.mean()) means.push_back(*mean);
    }
    const Axes axes = fitting_axes(points);
    std::string svg = fmt::format(
        "<svg class='frontier' xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' role='img' "
        "aria-label='Accuracy over time of {} techniques; the dashed line is the frontier of their means'>\n",
        kWidth, kLegendTop + kLegendRow * double(techniques.size()), techniques.size());
    svg += kStyle + time_ticks(axes) + accuracy_ticks(axes, accuracy_name) + frontier_line(axes, means) +
           marks(axes, techniques);
    for (std::size_t i = 0; i < techniques.size(); ++i)
        svg += legend_row(i, kLegendTop + kLegendRow * double(i), techniques[i]);
    return svg + "</svg>\n";
}

}  // namespace pellucid
