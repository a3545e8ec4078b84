#pragma once

#include "lab/experiments.h"

#include "report/report_folder.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace pellucid::cli {

/// An image of an experiment's grid.
struct GridPicture {
    std::string scene, caption, file;
};

/// Data of the whole run for the pages.
struct ExperimentHeader {
    std::string device, driver, version, cpu, environment, size;
    std::string command;  ///< command that repeats the run
};

/// The folder of one experiment: its page, the same content as Markdown, plots and images. Images are written
/// immediately and the page last, as in Report. Throws Error if a file cannot be written.
class ExperimentPage {
public:
    ExperimentPage(const std::filesystem::path& folder, const ExperimentSpec& spec);

    /// `caption`: the column of the grid; `scene`: its row.
    void add_picture(const std::string& scene, const std::string& caption, const Image& display);

    /// `runs`: as in the JSON output. Returns the page's file.
    std::filesystem::path finish(const ExperimentHeader& header, const nlohmann::ordered_json& runs,
                                 const std::vector<std::string>& warnings);

private:
    const ExperimentSpec& spec_;
    ReportFolder folder_;
    std::vector<GridPicture> pictures_;
};

/// The file beside an experiment's page that keeps its results for a later run.
std::filesystem::path experiment_results(const std::filesystem::path& report, const ExperimentSpec& spec);

/// Writes DIR/index.html with links to all experiments that have a page in DIR. Returns its path.
std::filesystem::path write_experiment_index(const std::filesystem::path& folder);

}  // namespace pellucid::cli
