#pragma once

#include "lab/experiment_page.h"
#include "lab/experiments.h"
#include "options/console.h"
#include "options/unread_scenes.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <set>
#include <string>

namespace pellucid::cli {

/// What the runs of all experiments have in common, and what they leave behind.
struct ExperimentRun {
    Renderer& renderer;
    std::uint32_t width, height;  ///< pixels
    int frames;                   ///< that are timed
    std::uint32_t threads;        ///< of Embree; 0: all
    UnreadScenes& unread;
    const Console& console;
    std::set<std::string> warnings;
    nlohmann::ordered_json runs = nlohmann::ordered_json::array();
};

/// The variants whose techniques this build and this device have; the others are named in the warnings.
std::vector<Variant> available_variants(const ExperimentSpec& spec, ExperimentRun& run);

/// Draws and measures every variant on every scene; prints a line for each.
void run_experiment(ExperimentRun& run, const ExperimentSpec& spec, const std::vector<ExperimentScene>& scenes,
                    const std::vector<Variant>& variants, ExperimentPage& page);

}  // namespace pellucid::cli
