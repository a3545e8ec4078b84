#include "bind.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <fmt/format.h>

#include <optional>

namespace pellucid::python {
namespace {

constexpr double kPixelsPerDegree = 67.020645;

py::array flip(const py::object& reference, const py::object& test, bool hdr, std::optional<float> exposure_ev,
               double pixels_per_degree) {
    const Image a = to_image(reference, "reference", 3), b = to_image(test, "test", 3);
    Image map;
    {
        const py::gil_scoped_release release;
        if (hdr) {
            FlipExposures exposures = flip_exposures(a);
            if (exposure_ev) exposures = {double(*exposure_ev), double(*exposure_ev), 1};
            map = flip_hdr(a, b, exposures, pixels_per_degree);
        } else {
            map = flip_ldr(a, b, pixels_per_degree);
        }
    }
    return image_array(std::move(map));
}

py::dict compare(const py::object& reference, const py::object& test, const py::object& mask, bool hdr) {
    py::array map = flip(reference, test, hdr, std::nullopt, kPixelsPerDegree);
    const std::vector<std::uint8_t> pixels = to_mask(mask, "mask");
    const Image a = to_image(reference, "reference", 3), b = to_image(test, "test", 3);
    const double flip_mean = mean(to_image(map, "flip"), pixels);
    return py::dict(py::arg("flip") = map, py::arg("flip_mean") = flip_mean, py::arg("rmse") = rmse(a, b, pixels));
}

py::dict compare_thickness(const py::object& truth, const py::object& thickness) {
    Image difference;
    const ThicknessError error =
        thickness_error(to_image(truth, "truth", 1), to_image(thickness, "thickness", 1), &difference);
    return py::dict(py::arg("difference") = image_array(std::move(difference)), py::arg("points") = error.points,
                    py::arg("unmatched") = error.unmatched, py::arg("relative") = error.relative,
                    py::arg("mean") = error.mean, py::arg("p95") = error.p95, py::arg("largest") = error.largest);
}

/// As apps/lab/accuracy.cpp has it: a pixel's footprint at the eye and its growth along the path.
PixelFootprint footprint_of(const Camera& camera, int height) {
    if (camera.orthographic) return {camera.vertical_extent / float(height), 0.0f};
    return {0.0f, 2.0f * std::tan(camera.vertical_fov / 2.0f) / float(height)};
}

py::dict compare_paths(const py::array& exact, const py::array& candidate, const Camera& camera,
                       const py::object& stable) {
    const std::vector<RefractedPath> truth = to_paths(exact, "exact"), paths = to_paths(candidate, "candidate");
    if (exact.ndim() != 2 || candidate.ndim() != 2 || exact.shape(0) != candidate.shape(0) ||
        exact.shape(1) != candidate.shape(1))
        throw Error(fmt::format("candidate: must be of shape {}, not {}", shape_of(exact), shape_of(candidate)));
    const int height = int(exact.shape(0)), width = int(exact.shape(1));
    std::vector<std::uint8_t> pixels = to_mask(stable, "stable");
    if (pixels.empty()) pixels.assign(truth.size(), 1);
    if (pixels.size() != truth.size()) throw Error(fmt::format("stable: must be of shape {}", shape_of(exact)));
    Image error = path_error_image(width, height, truth, paths, footprint_of(camera, height));
    const PathAccuracy accuracy = path_accuracy(truth, paths, error, pixels);
    return py::dict(py::arg("error_deg") = image_array(std::move(error)), py::arg("covered") = accuracy.covered,
                    py::arg("within_1deg") = accuracy.within_1deg, py::arg("within_5deg") = accuracy.within_5deg,
                    py::arg("stable_share") = accuracy.stable_share,
                    py::arg("within_1deg_stable") = accuracy.within_1deg_stable,
                    py::arg("median_deg") = accuracy.median_deg, py::arg("p95_deg") = accuracy.p95_deg);
}

void bind_image_files(py::module_& module) {
    module.def(
        "read_image", [](const std::filesystem::path& file) { return image_array(read_image(file)); }, py::arg("file"),
        "float32 (height, width[, channels]): an image file; 8 and 16 bit values become 0..1.");
    module.def(
        "write_image",
        [](const std::filesystem::path& file, const py::object& image, const std::vector<std::string>& channels) {
            const Image pixels = to_image(image, "image");
            channels.empty() ? write_image(file, pixels) : write_image(file, pixels, channels);
        },
        py::arg("file"), py::arg("image"), py::arg("channels") = py::list(),
        "Writes .exr (32-bit float) or .png (8 bit, of values 0..1). channels: names, one per channel, for .exr. The "
        "file appears complete or not at all.");
}

}  // namespace

void bind_measures(py::module_& module) {
    bind_image_files(module);
    module.def("flip", &flip, py::arg("reference"), py::arg("test"), py::kw_only(), py::arg("hdr") = false,
               py::arg("exposure_ev") = py::none(), py::arg("pixels_per_degree") = kPixelsPerDegree,
               "float32 (height, width), 0..1: FLIP, the perceived difference of two images (height, width, 3). "
               "hdr False: sRGB-encoded, 0..1 (LDR-FLIP). True: linear (HDR-FLIP), at the exposures that suit the "
               "reference, or at exposure_ev.");
    module.def("compare", &compare, py::arg("reference"), py::arg("test"), py::arg("mask") = py::none(), py::kw_only(),
               py::arg("hdr") = false,
               "dict of flip (height, width), and over the pixels of `mask` flip_mean (0..1) and rmse.");
    module.def("compare_thickness", &compare_thickness, py::arg("truth"), py::arg("thickness"),
               "dict: difference (height, width), mean, p95, largest, all in m; relative, points, unmatched.");
    module.def("compare_paths", &compare_paths, py::arg("exact"), py::arg("candidate"), py::arg("camera"),
               py::arg("stable") = py::none(),
               "dict: error_deg (height, width; 0..180, -1 where no glass is), covered (pixels), within_1deg, "
               "within_5deg, stable_share, within_1deg_stable (shares), median_deg, p95_deg. stable: mask of pixels "
               "that a small shift of the ray does not change.");
}

}  // namespace pellucid::python
