#pragma once

#include "report/report_folder.h"

#include <pellucid/image.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace pellucid {

/// Content of an image in a report, and its format for Report::add_picture().
enum class PictureKind {
    kImage,     ///< RGB, 0..1, encoded for display
    kAnalysis,  ///< RGB, 0..1, encoded for display: the technique's analysis view
    kError,     ///< 1 channel, degrees from path_error_image(): 0..180, -1 not covered
    kFlip,      ///< 1 channel, 0..1 from flip_ldr()
};

/// Identification of an image.
struct PictureOf {
    std::string scene;      ///< as in the runs
    int view = 0;           ///< as in the runs
    std::string technique;  ///< as in the runs; empty: the exact image, to which the others are compared
};

/// Data of the whole comparison; the report omits empty lines.
struct ReportHeader {
    std::string device, driver, version;
    std::string command;    ///< as typed
    std::string reference;  ///< description of the exact images, for instance "exact refraction, at most 16 events"
};

/// Writes the report of a comparison: a folder with a page that opens from disk in any browser, without a network.
///
/// Images are written immediately and the page last, so a killed run leaves no wrong page. Names may contain any
/// bytes; invalid UTF-8 is shown as U+FFFD. The page keeps the order of images and runs. Every function throws Error
/// naming the file if it cannot be written.
class Report {
public:
    /// Creates the folder and its parents if missing. Removes an older report in it, its page first; other files stay.
    /// Throws Error if one of them has a name that the report needs.
    explicit Report(const std::filesystem::path& folder);

    /// Writes one image at full size. Colours maps (error, flip) and finds their worst region.
    void add_picture(const PictureOf& of, PictureKind kind, const Image& image);

    /// Adds one element of the JSON's "runs" (MEASURES of `pellucid compare`): "scene", "technique" and "view", and
    /// the measurements. "frame_ms", a number, is the time of a frame; a run without it is in no frontier.
    void add_run(const nlohmann::ordered_json& run);

    /// Writes the data, the frontier plot and then the page. Returns the page's file.
    std::filesystem::path finish(const ReportHeader& header);

private:
    std::string new_picture_file(const PictureOf& of, PictureKind kind) const;

    ReportFolder folder_;
    nlohmann::ordered_json pictures_ = nlohmann::ordered_json::array();
    nlohmann::ordered_json runs_ = nlohmann::ordered_json::array();
};

}  // namespace pellucid
