#pragma once

#include "lab/experiments.h"

#include "report/report_folder.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::cli {

/// A picture of an experiment's grid.
struct GridPicture {
    std::string scene, caption, file;
};

/// What the pages say about a run of the command as a whole.
struct ExperimentHeader {
    std::string device, driver, version, cpu, environment, size;
    std::string command;  ///< with which others can repeat it
};

/// The folder of one experiment: its page, the same as Markdown for other documents, plots and pictures.
/// Pictures are written as they come and the page last, as in Report. Throws Error if something cannot be written.
class ExperimentPage {
public:
    ExperimentPage(const std::filesystem::path& folder, const ExperimentSpec& spec);

    /// `caption`: the column of the grid; `scene`: its row.
    void add_picture(const std::string& scene, const std::string& caption, const Image& display);

    /// `runs` as the JSON has them. Returns the page's file.
    std::filesystem::path finish(const ExperimentHeader& header, const nlohmann::ordered_json& runs,
                                 const std::vector<std::string>& warnings);

private:
    const ExperimentSpec& spec_;
    ReportFolder folder_;
    std::vector<GridPicture> pictures_;
};

/// Writes DIR/index.html with a link to every experiment whose page is in DIR, and returns it.
std::filesystem::path write_experiment_index(const std::filesystem::path& folder);

}  // namespace pellucid::cli
