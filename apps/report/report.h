#pragma once

#include "report/report_folder.h"

#include <pellucid/image.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace pellucid {

/// What a picture of a report shows, and what Report::add_picture() expects of it.
enum class PictureKind {
    kImage,     ///< RGB, 0..1, encoded for display
    kAnalysis,  ///< RGB, 0..1, encoded for display: the technique's analysis view
    kError,     ///< 1 channel, degrees as path_error_image() gives them: 0..180, -1 not covered
    kFlip,      ///< 1 channel, 0..1 as flip_ldr() gives it
};

/// Which picture it is.
struct PictureOf {
    std::string scene;      ///< as in the runs
    int view = 0;           ///< as in the runs
    std::string technique;  ///< as in the runs; empty: the exact picture, which the others are held against
};

/// What the report says about the comparison as a whole; empty lines are left out.
struct ReportHeader {
    std::string device, driver, version;
    std::string command;    ///< as it was typed
    std::string reference;  ///< what the exact pictures are, for instance "exact refraction, at most 16 events"
};

/// Writes the report of a comparison: a folder with a page that opens from disk in any browser, without a network.
///
/// Pictures are written as they come and the page last: a run that is killed leaves no page that lies. Names may
/// hold anything; bytes that are no UTF-8 are shown as U+FFFD. The order of pictures and runs is the page's.
/// Every function throws Error naming the file if something cannot be written.
class Report {
public:
    /// Makes the folder, and its parents, where missing. An older report in it is removed, its page first; files that
    /// are not of a report stay. Throws Error if one of those has a name that the report needs.
    explicit Report(const std::filesystem::path& folder);

    /// Writes one picture at full size. Maps (error, flip) are coloured here, and their worst region is found.
    void add_picture(const PictureOf& of, PictureKind kind, const Image& image);

    /// One element of the JSON's "runs" (MEASURES of `pellucid compare`): "scene", "technique" and "view", and
    /// whatever was measured. "frame_ms", a number, is the time of a frame; without it the run is in no frontier.
    void add_run(const nlohmann::ordered_json& run);

    /// Writes the data, the frontier plot and then the page; returns the page's file.
    std::filesystem::path finish(const ReportHeader& header);

private:
    std::string new_picture_file(const PictureOf& of, PictureKind kind) const;

    ReportFolder folder_;
    nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
    nlohmann::ordered_json runs_ = nlohmann::ordered_json::array();
};

}  // namespace pellucid
