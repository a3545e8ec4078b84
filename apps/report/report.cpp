#include "report/report.h"

#include "report/color_scale.h"
#include "report/frontier.h"
#include "report/worst_region.h"

#include <pellucid/file.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace pellucid {
namespace {

using nlohmann::ordered_json;

constexpr unsigned char kPageBytes[] = {
#include "index.html.inc"
};
constexpr unsigned char kStyleBytes[] = {
#include "report.css.inc"
};
constexpr unsigned char kScriptBytes[] = {
#include "report.js.inc"
};

constexpr const char* kPage = "index.html";
constexpr const char* kStyleFile = "report.css";
constexpr const char* kScript = "report.js";
constexpr const char* kData = "data.js";
constexpr const char* kFrontier = "frontier.svg";

template <std::size_t size>
std::string_view text_of(const unsigned char (&bytes)[size]) {
    return {reinterpret_cast<const char*>(bytes), size};
}

const char* kind_name(PictureKind kind) {
    switch (kind) {
        case PictureKind::kImage:
            return "image";
        case PictureKind::kAnalysis:
            return "analysis";
        case PictureKind::kError:
            return "error";
        case PictureKind::kFlip:
            return "flip";
    }
    return "";
}

/// JSON as ASCII text for any names: readable in any encoding, and no line separator ends a string early.
std::string script_text(const ordered_json& json) {
    return json.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
}

/// The same value with every string in valid UTF-8.
ordered_json valid_utf8(const ordered_json& json) { return ordered_json::parse(script_text(json)); }

/// Converts `name` into a part of a file name valid on every file system: its last path component, in lower case.
std::string file_name_part(std::string_view name) {
    constexpr std::size_t kLongest = 40;
    while (name.ends_with('/')) name.remove_suffix(1);
    name.remove_prefix(name.rfind('/') + 1);  // npos + 1 is 0
    std::string part;
    for (const char c : name.substr(0, kLongest)) {
        const bool upper = c >= 'A' && c <= 'Z';
        const bool plain = upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
        part += !plain ? '_' : upper ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return part;
}

ordered_json described(const Region& region) {
    return {{"x", region.x}, {"y", region.y}, {"size", region.size}, {"mean", region.mean}};
}

/// Data for the page's legends: some colours of the scale, between which the page interpolates.
ordered_json described_scale() {
    constexpr int kSamples = 33;
    const ColorScale scale;
    ordered_json colors = ordered_json::array();
    for (int i = 0; i < kSamples; ++i) colors.push_back(hex_color(scale.at(float(i) / float(kSamples - 1))));
    return {{"colors", std::move(colors)},
            {"uncovered", hex_color(kUncoveredColor)},
            {"least_deg", kLeastErrorDeg},
            {"greatest_deg", kGreatestErrorDeg}};
}

/// Accuracy measure of the plot: the share of right stable pixels, if every run has it.
const char* accuracy_key(const ordered_json& runs) {
    const bool stable = std::all_of(runs.begin(), runs.end(),
                                    [](const ordered_json& run) { return run.contains("within_1deg_stable"); });
    return stable ? "within_1deg_stable" : "within_1deg";
}

std::vector<TechniquePerformance> performances(const ordered_json& runs, const char* accuracy) {
    std::vector<TechniquePerformance> techniques;
    for (const ordered_json& run : runs) {
        const std::string name = run.at("technique");
        auto technique =
            std::find_if(techniques.begin(), techniques.end(), [&](const auto& t) { return t.name == name; });
        if (technique == techniques.end()) technique = techniques.insert(technique, {name, {}});
        const auto time = run.find("frame_ms");
        const auto share = run.find(accuracy);
        if (time == run.end() || share == run.end() || !time->is_number() || !share->is_number()) continue;
        if (time->get<double>() > 0.0) technique->runs.push_back({*time, *share});
    }
    return techniques;
}

std::string frontier_of(const ordered_json& runs) {
    const std::string accuracy = accuracy_key(runs);
    return frontier_svg(performances(runs, accuracy.c_str()),
                        accuracy == "within_1deg" ? "within 1 degree" : "within 1 degree, stable pixels");
}

}  // namespace

Report::Report(const std::filesystem::path& folder) : folder_(folder) {
    // Claim all names before long work, to detect conflicts. The page is first on the list, and is therefore removed
    // first.
    for (const char* name : {kPage, kStyleFile, kScript, kData, kFrontier}) folder_.claim(name);
}

std::string Report::new_picture_file(const PictureOf& of, PictureKind kind) const {
    const std::string technique = of.technique.empty() ? "exact" : file_name_part(of.technique);
    const std::string stem =
        fmt::format("pictures/{}-view{}-{}-{}", file_name_part(of.scene), of.view, technique, kind_name(kind));
    std::string file = stem + ".png";
    for (int i = 2; folder_.has(file); ++i) file = fmt::format("{}-{}.png", stem, i);
    return file;
}

void Report::add_picture(const PictureOf& of, PictureKind kind, const Image& image) {
    const std::string file = new_picture_file(of, kind);
    ordered_json picture{{"scene", of.scene},       {"view", of.view}, {"technique", of.technique},
                         {"kind", kind_name(kind)}, {"file", file},    {"width", image.width},
                         {"height", image.height}};
    const bool map = kind == PictureKind::kError || kind == PictureKind::kFlip;
    if (const std::optional<Region> worst = map ? worst_region(image) : std::nullopt)
        picture["worst"] = described(*worst);
    const std::filesystem::path path = folder_.claim(file);
    if (kind == PictureKind::kError)
        write_image(path, color_errors(image));
    else if (kind == PictureKind::kFlip)
        write_image(path, color_flip(image));
    else
        write_image(path, image);
    pictures_.push_back(std::move(picture));
}

void Report::add_run(const ordered_json& run) { runs_.push_back(valid_utf8(run)); }

std::filesystem::path Report::finish(const ReportHeader& header) {
    const std::string frontier = frontier_of(runs_);
    const ordered_json data{{"header",
                             {{"device", header.device},
                              {"driver", header.driver},
                              {"version", header.version},
                              {"command", header.command},
                              {"reference", header.reference}}},
                            {"scale", described_scale()},
                            {"pictures", pictures_},
                            {"runs", runs_},
                            {"frontier", frontier}};
    write_text_file(folder_ / kData, "window.pellucidReport = " + script_text(data) + ";\n");
    write_text_file(folder_ / kStyleFile, text_of(kStyleBytes));
    write_text_file(folder_ / kScript, text_of(kScriptBytes));
    if (!frontier.empty()) write_text_file(folder_ / kFrontier, frontier);
    write_text_file(folder_ / kPage, text_of(kPageBytes));
    return folder_ / kPage;
}

}  // namespace pellucid
