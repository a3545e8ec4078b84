#include "lab/experiment_page.h"

#include "lab/experiment_figures.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace pellucid::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kPage = "index.html";

constexpr const char* kStyle = R"(<style>
:root{color-scheme:light dark;--page:#f6f7f9;--text:#1d2125;--soft:#59626b;--rule:#dde1e5}
@media (prefers-color-scheme:dark){:root{--page:#15181b;--text:#e3e6e9;--soft:#a3acb5;--rule:#31373d}}
body{margin:0 auto;max-width:80rem;padding:1.5rem;background:var(--page);color:var(--text);font:16px/1.5 system-ui,sans-serif}
h1{margin:0;font-size:1.5rem}
p{max-width:50rem}
.soft{color:var(--soft)}
.wide{overflow-x:auto}
table{border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;border-bottom:1px solid var(--rule);text-align:right;vertical-align:bottom}
th:first-child,td:first-child{text-align:left}
td{white-space:nowrap}
.grid td,.grid th{padding:.2rem;border:0;text-align:center;vertical-align:middle}
.grid img{display:block;width:16rem;height:auto}
code{font-size:.9em}
</style>
)";

std::string page_head(const std::string& title) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n{1}<h1>{0}</h1>\n",
        escaped(title), kStyle);
}

/// Text for a file name: lower case, digits and dashes.
std::string file_name_part(const std::string& text) {
    std::string part;
    for (const char c : text) {
        const bool upper = c >= 'A' && c <= 'Z';
        if (upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
            part += upper ? char(c - 'A' + 'a') : c;
        else if (!part.empty() && part.back() != '-')
            part += '-';
    }
    while (part.ends_with('-')) part.pop_back();
    return part;
}

template <class Text>
std::vector<std::string> distinct(const std::vector<GridPicture>& pictures, Text text) {
    std::vector<std::string> values;
    for (const GridPicture& picture : pictures) {
        if (std::find(values.begin(), values.end(), picture.*text) == values.end()) values.push_back(picture.*text);
    }
    return values;
}

/// One row per scene, with the captions as head. `cell` converts an image into text.
template <class Cell>
TextTable grid_of(const std::vector<GridPicture>& pictures, Cell cell) {
    const std::vector<std::string> captions = distinct(pictures, &GridPicture::caption);
    TextTable grid{{""}};
    grid[0].insert(grid[0].end(), captions.begin(), captions.end());
    for (const std::string& scene : distinct(pictures, &GridPicture::scene)) {
        std::vector<std::string> row{scene};
        for (const std::string& caption : captions) {
            const auto found = std::find_if(pictures.begin(), pictures.end(), [&](const GridPicture& picture) {
                return picture.scene == scene && picture.caption == caption;
            });
            row.push_back(found == pictures.end() ? "" : cell(*found));
        }
        grid.push_back(std::move(row));
    }
    return grid;
}

std::string grid_html(const std::vector<GridPicture>& pictures) {
    const TextTable grid = grid_of(pictures, [](const GridPicture& picture) {
        return fmt::format("<a href='{0}'><img src='{0}' alt='{1}, {2}' loading='lazy'></a>", picture.file,
                           escaped(picture.scene), escaped(picture.caption));
    });
    std::string text = "<div class='wide'><table class='grid'>\n";
    for (std::size_t row = 0; row < grid.size(); ++row) {
        text += "<tr>";
        for (std::size_t i = 0; i < grid[row].size(); ++i) {
            const bool head = row == 0 || i == 0;
            text += head ? fmt::format("<th>{}</th>", escaped(grid[row][i])) : fmt::format("<td>{}</td>", grid[row][i]);
        }
        text += "</tr>\n";
    }
    return text + "</table></div>\n";
}

std::string grid_markdown(const std::vector<GridPicture>& pictures) {
    return markdown(grid_of(pictures, [](const GridPicture& picture) {
        return fmt::format("![{}, {}]({})", picture.scene, picture.caption, picture.file);
    }));
}

std::string machine_of(const ExperimentHeader& header) {
    return fmt::format("{}, environment {}. Version {}, {}, {}; {}.", header.size, header.environment, header.version,
                       header.device, header.driver, header.cpu);
}

std::string varied_of(const ExperimentSpec& spec) {
    return fmt::format("Varied: {}. Pictures are held against: {}.", spec.varied, spec.truth.label);
}

/// Throws Error if the folder contains a report other than an index of experiments, which the index would replace.
void check_index_folder(const fs::path& folder) {
    std::ifstream list(folder / ReportFolder::kList);
    std::string line;
    std::getline(list, line);
    while (std::getline(list, line)) {
        if (line != kPage) {
            throw Error(fmt::format("{}: holds another report, of which '{}' is a part; choose another --report",
                                    folder.string(), line));
        }
    }
}

}  // namespace

fs::path experiment_results(const fs::path& report, const ExperimentSpec& spec) {
    return report / spec.name / (std::string(spec.name) + ".json");
}

ExperimentPage::ExperimentPage(const fs::path& folder, const ExperimentSpec& spec) : spec_(spec), folder_(folder) {
    folder_.claim(kPage);  // first, so that it is also removed first from an older report
    folder_.claim(std::string(spec.name) + ".md");
    folder_.claim(experiment_results({}, spec).filename());
}

void ExperimentPage::add_picture(const std::string& scene, const std::string& caption, const Image& display) {
    const std::string file = fmt::format("{}-{}.png", file_name_part(scene), file_name_part(caption));
    write_image(folder_.claim(file), display);
    pictures_.push_back({scene, caption, file});
}

fs::path ExperimentPage::finish(const ExperimentHeader& header, const ordered_json& runs,
                                const std::vector<std::string>& warnings) {
    const TextTable table = table_of(spec_.columns, runs);
    std::string plots, plot_links;
    int number = 0;
    for (const Plot& plot : spec_.plots) {
        const std::string svg = plot_svg(plot, runs);
        if (svg.empty()) continue;
        const std::string file = fmt::format("plot-{}.svg", ++number);
        write_text_file(folder_.claim(file), svg);
        plots += svg;
        plot_links += fmt::format("![{}]({})\n\n", plot.title, file);
    }
    std::string remarks = *spec_.remark == '\0' ? "" : fmt::format("{}\n\n", spec_.remark);
    std::string markdown_warnings, html_warnings;
    for (const std::string& warning : warnings) {
        markdown_warnings += fmt::format("- {}\n", escaped(warning));
        html_warnings += fmt::format("<li>{}</li>\n", escaped(warning));
    }
    if (!warnings.empty()) {
        markdown_warnings = "Warnings:\n\n" + markdown_warnings + "\n";
        html_warnings = "<h2>Warnings</h2>\n<ul>" + html_warnings + "</ul>\n";
    }
    write_text_file(folder_ / (std::string(spec_.name) + ".md"),
                    fmt::format("{}.\n{}\n\n{}\n{}{}{}\n{}```sh\n{}\n```\n{}\n", spec_.source, varied_of(spec_),
                                markdown(table), remarks.empty() ? "" : remarks, plot_links, grid_markdown(pictures_),
                                markdown_warnings, header.command, machine_of(header)));
    std::string page = page_head(spec_.name);
    page += fmt::format("<p>{}.</p>\n<p class='soft'>{}</p>\n<div class='wide'>{}</div>\n<p>{}</p>\n",
                        escaped(spec_.source), escaped(varied_of(spec_)), html(table), escaped(spec_.remark));
    page += plots + grid_html(pictures_) + html_warnings;
    page += fmt::format("<p class='soft'><code>{}</code><br>{}<br><a href='../{}'>All experiments</a></p>\n</html>\n",
                        escaped(header.command), escaped(machine_of(header)), kPage);
    write_text_file(folder_ / kPage, page);
    return folder_ / kPage;
}

fs::path write_experiment_index(const fs::path& folder) {
    check_index_folder(folder);
    ReportFolder report(folder);
    const fs::path file = report.claim(kPage);
    std::string page = page_head("Experiments");
    page += "<p>Experiments of the publications that Pellucid follows, repeated with it.</p>\n<ul>\n";
    std::error_code ignored;
    for (const ExperimentSpec& spec : experiments()) {
        if (!fs::is_regular_file(folder / spec.name / kPage, ignored)) continue;
        page += fmt::format("<li><a href='{0}/{1}'>{0}</a>: {2}. <span class='soft'>Varied: {3}.</span></li>\n",
                            spec.name, kPage, escaped(spec.source), escaped(spec.varied));
    }
    write_text_file(file, page + "</ul>\n</html>\n");
    return file;
}

}  // namespace pellucid::cli
