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

/// One variant of drawing an experiment's scenes.
struct Variant {
    std::string label;
    std::string technique;
    ParameterMap parameters = {};
    /// Width in texels of an equirectangular map, half as high, that replaces the experiment's environment; empty: no
    /// replacement.
    std::optional<int> map_width = {};
    std::optional<std::uint32_t> samples = {};  ///< jittered frames; none: the experiments' own number
    bool analysis = false;                      ///< add the technique's analysis view
};

/// One of the scenes of an experiment.
struct ExperimentScene {
    std::string label;
    BenchCase how;                                 ///< source, distance, copies
    Scene (*make)() = nullptr;                     ///< instead of how.source
    bool close_holes = false;                      ///< of the model's meshes
    std::optional<float> ior = {};                 ///< instead of the index of refraction of all materials
    std::map<std::string, double> published = {};  ///< measurements of the publication for a similar scene
};

/// A column of the table, or a line of a plot, from a number of the run's JSON.
struct Column {
    const char* head;
    const char* pointer;  ///< JSON pointer into the run (RFC 6901)
    double scale = 1.0;
    int digits = 1;
};

/// A plot over the variants, or over the scenes.
struct Plot {
    const char* title;
    const char* unit;
    bool over_scenes = false;
    std::vector<Column> lines;
};

struct ExperimentRun;
class ExperimentPage;
struct ExperimentSpec;

/// Runs an experiment that does not measure refraction: fills the runs and the page's images.
using RunExperiment = void (*)(ExperimentRun& run, const ExperimentSpec& spec, ModelFolder& models,
                               ExperimentPage& page);

/// An experiment of a publication, as data.
struct ExperimentSpec {
    const char* name;
    const char* source;
    const char* varied;
    const char* environment = "studio";
    std::pair<std::uint32_t, std::uint32_t> size = {512, 512};
    std::vector<Variant> variants = {};
    Variant truth = {"exact", "reference"};  ///< reference image for FLIP and RMSE
    std::vector<ExperimentScene> (*scenes)(ModelFolder& models) = nullptr;
    RunExperiment run = nullptr;  ///< instead of variants and scenes
    bool timed = false;           ///< time frames, alternating with Embree
    bool zoom = false;            ///< add images of the first variant's worst region
    std::vector<Column> columns;
    std::vector<Plot> plots = {};
    const char* remark = "";
};

/// All experiments, in the order of `all`.
std::span<const ExperimentSpec> experiments();

/// Throws Error listing the known experiments.
const ExperimentSpec& find_experiment(const std::string& name);

}  // namespace pellucid::cli
