#pragma once

#include "lab/bench_suites.h"
#include "options/model_files.h"

#include <pellucid/pellucid.h>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pellucid::cli {

/// One of the ways in which an experiment draws its scenes.
struct Variant {
    std::string label;
    std::string technique;
    ParameterMap parameters = {};
    /// The experiment's environment as an equirectangular map so many texels wide and half as high; none: as it is.
    std::optional<int> map_width = {};
    bool analysis = false;  ///< the technique's analysis view as well
};

/// One of the scenes of an experiment.
struct ExperimentScene {
    std::string label;
    BenchCase how;                                 ///< source, distance, copies
    Scene (*make)() = nullptr;                     ///< instead of how.source
    std::map<std::string, double> published = {};  ///< what the publication measured on its like
};

/// A column of the table, or a line of a plot: a number of the run's JSON.
struct Column {
    const char* head;
    const char* pointer;  ///< into the run (RFC 6901)
    double scale = 1.0;
    int digits = 1;
};

/// What is drawn over the variants, or over the scenes.
struct Plot {
    const char* title;
    const char* unit;
    bool over_scenes = false;
    std::vector<Column> lines;
};

struct ExperimentRun;
class ExperimentPage;
struct ExperimentSpec;

/// Measures something else than refraction: fills the runs and the page's pictures.
using RunExperiment = void (*)(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder& models,
                               ExperimentPage& page);

/// An experiment of a publication, as far as it is data.
struct ExperimentSpec {
    const char* name;
    const char* source;
    const char* varied;
    const char* environment = "studio";
    std::pair<std::uint32_t, std::uint32_t> size = {512, 512};
    std::vector<Variant> variants = {};
    Variant truth = {"exact", "reference"};  ///< whose picture FLIP and RMSE are taken against
    std::vector<ExperimentScene> (*scenes)(ModelFolder& models) = nullptr;
    RunExperiment run = nullptr;  ///< instead of variants and scenes
    bool timed = false;           ///< frames, in turn with Embree
    bool zoom = false;            ///< pictures of the worst region of the first variant as well
    std::vector<Column> columns;
    std::vector<Plot> plots = {};
    const char* remark = "";
};

/// All of them, in the order in which `all` runs them.
std::span<const ExperimentSpec> experiments();

/// Throws Error listing the known ones.
const ExperimentSpec& find_experiment(const std::string& name);

}  // namespace pellucid::cli
