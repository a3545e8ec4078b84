#pragma once

#include "options/model_files.h"

#include <pellucid/pellucid.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pellucid::cli {

/// One picture that is timed.
struct BenchCase {
    std::string scene = {};   ///< as results name it: without folders, which differ from machine to machine
    std::string source = {};  ///< for load_scene()
    std::string varied = {};  ///< what the cases of a suite differ in: "distance", "triangles"; empty: nothing
    int copies = 1;           ///< of every object, on a grid
    /// Of the orbit camera, bounding-sphere radii; none: the file's camera, or one that frames the scene.
    std::optional<float> distance = {};
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size = {};  ///< pixels; none: as asked for
    std::optional<double> layers = {};  ///< of the techniques that have this parameter; others are left out
};

/// Camera of a case. Orbit cameras stand at azimuth 0 and elevation 15 degrees.
Camera bench_camera(const BenchCase& bench_case, const Scene& scene, std::uint32_t width, std::uint32_t height);

/// The scene with every object `copies` times, side by side on a square grid that faces the camera.
Scene with_copies(Scene scene, int copies);

/// The cases of a suite. Model files come from `models`; one that is missing is left out with a warning.
/// Throws Error listing the known suites for an unknown name.
std::vector<BenchCase> suite_cases(const std::string& name, ModelFolder& models);
/// Names and what they are.
std::vector<std::pair<std::string_view, std::string_view>> suite_infos();

}  // namespace pellucid::cli
