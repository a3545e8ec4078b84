#include "lab/experiment_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pellucid::cli {
namespace {

using nlohmann::ordered_json;

std::optional<double> number_at(const ordered_json& run, const Column& column) {
    const ordered_json::json_pointer at(column.pointer);
    if (!run.contains(at) || !run[at].is_number()) return std::nullopt;
    return column.scale * run[at].get<double>();
}

/// Inserts thousands separators: 69664 becomes 69,664.
std::string with_commas(std::string digits) {
    for (std::size_t at = digits.find('.') == std::string::npos ? digits.size() : digits.find('.'); at > 3;) {
        at -= 3;
        if (digits[at - 1] != '-') digits.insert(at, ",");
    }
    return digits;
}

/// Distinct values of a key of the runs, in order of appearance.
std::vector<std::string> distinct(const ordered_json& runs, const char* key) {
    std::vector<std::string> values;
    for (const ordered_json& run : runs) {
        const std::string value = run.at(key);
        if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
    return values;
}

template <class Cell>
std::string joined_rows(const TextTable& table, Cell cell) {
    std::string text;
    for (std::size_t row = 0; row < table.size(); ++row) text += cell(table[row], row);
    return text;
}

// Pixels of the plot.
constexpr double kWidth = 560.0, kLeft = 52.0, kRight = 544.0, kTop = 40.0, kBottom = 260.0;
constexpr double kLegendTop = 312.0, kLegendRow = 20.0;
/// Colours of the frontier plot: of equal lightness, with enough contrast on white and on black.
constexpr std::array kColors = {"#3284d0", "#cb6620", "#2d9570", "#c74c8e", "#9d8519", "#8362cd"};

constexpr const char* kPlotStyle = R"(<style>
.plot{font:13px system-ui,sans-serif;--ink:#1d2125;--soft:#59626b;--rule:#dde1e5;fill:var(--ink);max-width:35rem}
.plot .grid{stroke:var(--rule)}
.plot .soft{fill:var(--soft)}
.plot .end{text-anchor:end}
.plot .middle{text-anchor:middle}
@media (prefers-color-scheme:dark){.plot{--ink:#e3e6e9;--soft:#a3acb5;--rule:#31373d}}
</style>
)";

/// One line of a plot: an optional value for each position.
struct Line {
    std::string name;
    std::vector<std::optional<double>> values;

    std::size_t count() const {
        return std::size_t(
            std::count_if(values.begin(), values.end(), [](const auto& value) { return value.has_value(); }));
    }
};

std::vector<Line> lines_of(const Plot& plot, const ordered_json& runs, const std::vector<std::string>& places) {
    const char* along = plot.over_scenes ? "scene" : "variant";
    const char* across = plot.over_scenes ? "variant" : "scene";
    const std::vector<std::string> others = distinct(runs, across);
    std::vector<Line> lines;
    for (const std::string& other : others) {
        for (const Column& column : plot.lines) {
            Line line{others.size() == 1       ? column.head
                      : plot.lines.size() == 1 ? other
                                               : fmt::format("{}: {}", other, column.head),
                      std::vector<std::optional<double>>(places.size())};
            for (const ordered_json& run : runs) {
                if (run.at(across) != other) continue;
                const auto place = std::find(places.begin(), places.end(), run.at(along).get<std::string>());
                line.values[std::size_t(place - places.begin())] = number_at(run, column);
            }
            if (line.count() > 0) lines.push_back(std::move(line));
        }
    }
    return lines;
}

/// Step of the axis, 1, 2 or 5 times a power of ten, that gives four to nine steps.
double axis_step(double greatest) {
    const double power = std::pow(10.0, std::floor(std::log10(greatest)));
    for (const double digit : {0.1, 0.2, 0.5, 1.0}) {
        if (greatest / (digit * power) <= 9.0) return digit * power;
    }
    return 2.0 * power;
}

/// Coordinates of positions and values in the plot.
struct PlotAxes {
    std::size_t places;
    double step, greatest;

    double x(std::size_t place) const { return kLeft + (kRight - kLeft) * (double(place) + 0.5) / double(places); }
    double y(double value) const { return std::lerp(kBottom, kTop, value / greatest); }
};

std::string drawn_axes(const Plot& plot, const PlotAxes& axes, const std::vector<std::string>& places) {
    const std::string unit = *plot.unit == '\0' ? "" : fmt::format(", {}", plot.unit);
    std::string svg = fmt::format("<text class='soft' x='0' y='16'>{}{}</text>\n", escaped(plot.title), unit);
    for (int i = 0; i * axes.step <= axes.greatest * 1.0001; ++i) {
        const double y = axes.y(i * axes.step);
        svg += fmt::format(
            "<path class='grid' d='M{} {:.1f}H{}'/><text class='soft end' x='{}' y='{:.1f}'>{:.4g}</text>\n", kLeft, y,
            kRight, kLeft - 8.0, y + 4.5, i * axes.step);
    }
    // Labels of many positions alternate between two rows, to avoid overlap.
    const bool two_rows = places.size() > 5;
    for (std::size_t i = 0; i < places.size(); ++i)
        svg += fmt::format("<text class='soft middle' x='{:.1f}' y='{}'>{}</text>\n", axes.x(i),
                           kBottom + (two_rows && i % 2 == 1 ? 34.0 : 18.0), escaped(places[i]));
    return svg;
}

std::string drawn_line(const Line& line, std::size_t index, const PlotAxes& axes, bool connected) {
    const char* color = kColors[index % kColors.size()];
    std::string path, marks;
    for (std::size_t i = 0; i < line.values.size(); ++i) {
        if (!line.values[i]) continue;
        const double x = axes.x(i), y = axes.y(*line.values[i]);
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
        marks += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4.5' fill='{}'><title>{:.4g}</title></circle>\n", x, y,
                             color, *line.values[i]);
    }
    const double y = kLegendTop + kLegendRow * double(index);
    std::string svg;
    if (connected) svg = fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='2'/>\n", path, color);
    return svg + marks +
           fmt::format("<circle cx='{}' cy='{}' r='4.5' fill='{}'/><text x='{}' y='{}'>{}</text>\n", kLeft, y, color,
                       kLeft + 14.0, y + 4.5, escaped(line.name));
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '&')
            result += "&amp;";
        else if (c == '<')
            result += "&lt;";
        else if (c == '>')
            result += "&gt;";
        else if (c == '\'')
            result += "&#39;";
        else
            result += c;
    }
    return result;
}

TextTable table_of(const std::vector<Column>& columns, const ordered_json& runs) {
    TextTable table(1 + runs.size());
    for (const auto& [key, head] : {std::pair("scene", "scene"), std::pair("variant", "")}) {
        if (distinct(runs, key).size() < 2 && *head == '\0') continue;
        table[0].emplace_back(head);
        for (std::size_t i = 0; i < runs.size(); ++i) table[1 + i].push_back(runs[i].at(key));
    }
    for (const Column& column : columns) {
        std::vector<std::string> cells;
        for (const ordered_json& run : runs) {
            const std::optional<double> number = number_at(run, column);
            cells.push_back(number ? with_commas(fmt::format("{:.{}f}", *number, column.digits)) : "");
        }
        if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); })) continue;
        table[0].emplace_back(column.head);
        for (std::size_t i = 0; i < cells.size(); ++i) table[1 + i].push_back(cells[i]);
    }
    return table;
}

std::string markdown(const TextTable& table) {
    return joined_rows(table, [](const std::vector<std::string>& cells, std::size_t row) {
        std::string line = fmt::format("| {} |\n", fmt::join(cells, " | "));
        if (row == 0) {
            for (std::size_t i = 0; i < cells.size(); ++i) line += "|---";
            line += "|\n";
        }
        return line;
    });
}

std::string html(const TextTable& table) {
    return "<table>\n" +
           joined_rows(table,
                       [](const std::vector<std::string>& cells, std::size_t row) {
                           const char* tag = row == 0 ? "th" : "td";
                           std::string line = "<tr>";
                           for (const std::string& cell : cells)
                               line += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
                           return line + "</tr>\n";
                       }) +
           "</table>\n";
}

std::string plot_svg(const Plot& plot, const ordered_json& runs) {
    const std::vector<std::string> places = distinct(runs, plot.over_scenes ? "scene" : "variant");
    const std::vector<Line> lines = lines_of(plot, runs, places);
    const bool any = std::any_of(lines.begin(), lines.end(), [](const Line& line) { return line.count() > 1; });
    double greatest = 0.0;
    for (const Line& line : lines)
        for (const std::optional<double>& value : line.values) greatest = std::max(greatest, value.value_or(0.0));
    if (!any || !(greatest > 0.0)) return {};
    PlotAxes axes{places.size(), axis_step(greatest), 0.0};
    axes.greatest = axes.step * std::ceil(greatest / axes.step);
    std::string svg = fmt::format(
        "<svg class='plot' xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {} {}' role='img' aria-label='{}'>\n",
        kWidth, kLegendTop + kLegendRow * double(lines.size()), escaped(plot.title));
    svg += kPlotStyle + drawn_axes(plot, axes, places);
    // Scenes have no order, so do not connect them by lines.
    for (std::size_t i = 0; i < lines.size(); ++i) svg += drawn_line(lines[i], i, axes, !plot.over_scenes);
    return svg + "</svg>\n";
}

}  // namespace pellucid::cli
