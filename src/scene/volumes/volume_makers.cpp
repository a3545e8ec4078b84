#include "scene/volumes/volume_building.h"

#include <pellucid/error.h>
#include <pellucid/names.h>

#include "core/fail.h"

namespace pellucid {
namespace {

struct Maker {
    ShapeInfo info;
    Volume (*make)(const ShapeArguments&);
};

const ShapeParameter kResolution{"resolution", 128, 4, 65536, "voxels along the longest side of the box"};
const ShapeParameter kSmoothing{"smoothing", 0, 0, 16,
                                "standard deviation of the Gaussian that smooths the index, voxels"};

const std::vector<Maker>& makers() {
    static const std::vector<Maker> table = {
        {{"luneburg",
          "Luneburg's lens, n = sqrt(2 - r^2): parallel rays meet where the one through the centre leaves it",
          {{"radius", 1.0, 0.001, 1000, "metres"}, kResolution, kSmoothing}},
         make_luneburg},
        {{"maxwell-fisheye",
          "Maxwell's fish-eye as a ball, n = n0 / (1 + r^2): a point of its surface is imaged opposite to it",
          {{"radius", 1.0, 0.001, 1000, "metres"},
           {"n0", 2.0, 0.2, 4, "index in the middle"},
           kResolution,
           kSmoothing}},
         make_maxwell_fisheye},
        {{"linear",
          "cube in which the index grows upwards, n = n0 + slope y",
          {{"size", 2.0, 0.001, 1000, "length of an edge, metres"},
           {"n0", 1.5, 0.1, 4, "index in the middle"},
           {"slope", 0.3, -100, 100, "by which it grows with a metre"},
           kResolution,
           kSmoothing}},
         make_linear},
        {{"smoothed-sphere", "ball with a smoothed surface",
          with_solid_parameters({{"radius", 1.0, 0.001, 1000, "metres"}})},
         make_smoothed_sphere},
        {{"rounded-cube", "cube with rounded edges, in layers if wanted",
          with_solid_parameters(
              {{"size", 1.6, 0.001, 1000, "length of an edge, metres"},
               {"rounding", 0.3, 0.01, 1, "radius of its edges, in halves of the edge's length"},
               {"layers", 1, 1, 16, "shells, all as thick; every second has other-ior and absorbs nothing"},
               {"other-ior", 1.2, 0.1, 4, "index of every second layer"}})},
         make_rounded_cube},
        {{"wine-glass", "surface of revolution: the shape goblet, 2 m high",
          with_solid_parameters({{"wall", 0.05, 0.02, 0.08, "thickness of the bowl's wall, metres"}})},
         make_wine_glass},
        {{"mirage",
          "air over hot ground, n = 1 - contrast exp(-y / scale)",
          {{"length", 20.0, 0.01, 10000, "of the ground, square, metres"},
           {"height", 1.0, 0.001, 1000, "of the box, metres"},
           {"contrast", 0.003, 0, 0.1, "by how much the index is less at the ground"},
           {"scale", 0.15, 0.0001, 100, "height in which that falls to its 2.718th part, metres"},
           {"resolution", 128, 4, 65536, "voxels along the longest side of the box"},
           kSmoothing}},
         make_mirage},
        {{"smoke",
          "cloud of scattering smoke, ragged by noise",
          {{"size", 2.0, 0.001, 10000, "length of an edge of the box, metres"},
           {"scattering", 4.0, 0, 1e6, "scattering where it is dense, 1/m"},
           {"g", 0.4, -0.99, 0.99, "mean cosine of scattering"},
           {"noise-scale", 0.5, 0.001, 1000, "width of the noise, metres"},
           kResolution}},
         make_smoke},
    };
    return table;
}

}  // namespace

const std::vector<ShapeInfo>& volume_infos() {
    static const std::vector<ShapeInfo> infos = [] {
        std::vector<ShapeInfo> result;
        for (const Maker& maker : makers()) result.push_back(maker.info);
        return result;
    }();
    return infos;
}

Volume make_volume(const std::string& spec) {
    const std::string name = spec.substr(0, spec.find(','));
    std::vector<std::string_view> known;
    for (const Maker& maker : makers()) {
        if (maker.info.name == name) {
            Volume volume =
                maker.make(ShapeArguments(maker.info, std::string_view(spec).substr(name.size()), "volume"));
            volume.name = name;
            check_volume(volume);
            return volume;
        }
        known.push_back(maker.info.name);
    }
    throw unknown_name("volume", shortened(name), known);
}

}  // namespace pellucid
