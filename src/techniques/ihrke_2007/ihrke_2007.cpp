#include "techniques/ihrke_2007/ihrke_2007.h"

#include "techniques/shaders.h"
#include "techniques/visibility_layers/visibility_layers.h"
#include "volume/draw_wavefronts.h"
#include "volume/scene_volumes.h"

#include <pellucid/error.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <optional>

namespace pellucid {
namespace {

constexpr NamedValue kIntegrators[] = {{0, "euler", "of first order"},
                                       {1, "runge-kutta", "of fourth order"},
                                       {2, "leapfrog", "of second order"},
                                       {3, "nystrom", "of fourth order"}};
constexpr NamedValue kInterpolations[] = {{0, "linear", "of index and gradient each, as in the paper"},
                                          {1, "cubic", "with the gradient of the index itself"}};
constexpr NamedValue kInterfaces[] = {
    {0, "smooth", "the voxels alone bend light, as in the paper"},
    {1, "sharp", "the index holds up to the mesh and light crosses that by Snell's law"}};
constexpr NamedValue kVoxelize[] = {
    {-1, "automatic", "a volume where the scene has none"}, {0, "off", "they stay surfaces"}, {1, "on", "a volume"}};
constexpr NamedValue kKeptLight[] = {{0, "brightest", "the brightest and its way, as in the paper"},
                                     {1, "sum", "all of it and its mean way"}};

constexpr std::array kOwnParameters = {
    ParameterInfo{"integrator", "", 3, 0, 3, true, "of the ray equation", kIntegrators},
    ParameterInfo{"step", "voxels", 0.5, 0.01, 8, false, "length of a step along view rays"},
    ParameterInfo{"interpolation", "", 1, 0, 1, true, "of the index along view rays", kInterpolations},
    ParameterInfo{"max-steps", "", 8192, 1, 60000, true, "steps of a view ray from one box or surface to the next"},
    ParameterInfo{"proxy", "", 1, 0, 1, true,
                  "view rays enter a volume that stands for a mesh at the mesh; off: the voxels alone say where it is",
                  kOffOn},
    ParameterInfo{"interfaces", "", 0, 0, 1, true, "of volumes that stand for meshes", kInterfaces},
    ParameterInfo{"voxelize", "", -1, -1, 1, true, "what solids of glass become", kVoxelize},
    ParameterInfo{"voxels", "", 128, 8, 2048, true, "along the longest side of the volume that glass becomes"},
    ParameterInfo{"smoothing", "voxels", 0.75, 0, 16, false,
                  "standard deviation of the Gaussian that smooths the index of that volume"},
    ParameterInfo{"kept-light", "", 1, 0, 1, true, "what voxels keep of light", kKeptLight},
    ParameterInfo{"folds", "", 1, 0, 1, true,
                  "light goes on past a focus; off: a piece of a wavefront that has turned over ends, as in the paper",
                  kOffOn},
    ParameterInfo{"light-step", "voxels", 0.5, 0.01, 8, false, "optical length of a step of light"},
    ParameterInfo{"reflected-light", "", 0, 0, 7, true,
                  "reflections of light in surfaces of volumes, one after another, that are followed"},
    ParameterInfo{"light-slices", "frames", 1, 1, 1000, true,
                  "over which a light that moves is traced; until the last of them the light before is shown"},
    ParameterInfo{"wavefront-spacing", "voxels", 16, 0.1, 4096, false,
                  "optical length from one wavefront to the next in the view wavefront, smallest voxels"},
    ParameterInfo{"patches", "", 262144, 64, 16777216, true, "pieces of wavefronts at once, at most"},
    ParameterInfo{"map-resolution", "", 512, 2, 8192, true,
                  "texels along the longest side of a mesh's box of the maps in which surfaces are found"},
};

constexpr auto kParameters = [] {
    std::array<ParameterInfo, kOwnParameters.size() + kPathParameters.size()> all{};
    std::copy(kOwnParameters.begin(), kOwnParameters.end(), all.begin());
    std::copy(kPathParameters.begin(), kPathParameters.end(), all.begin() + kOwnParameters.size());
    // What boundaries reflect belongs to the picture: there is no cheap stand-in for it as for a single sheet of glass.
    for (ParameterInfo& parameter : all)
        if (parameter.name == "branches")
            parameter.default_value = 4, parameter.doc = "reflected ways followed per pixel and sample";
    return all;
}();

class Volumes final : public PathVolumes {
public:
    Volumes(const SceneVolumes& volumes, const ParameterValues& parameters)
        : volumes_(volumes), images_(volumes.images()), parameters_(parameters) {}

    std::vector<Binding> bindings() const override {
        const LightVolumes& light = volumes_.light_volumes();
        // Where no light was traced something of the right kind stands in.
        const bool lit = volumes_.lit();
        return {reads("Volumes", images_.records),
                reads("volume_index", images_.index),
                reads("volume_bricks", images_.bricks),
                reads("volume_absorption", images_.absorption),
                reads("volume_scattering", images_.scattering),
                reads("volume_emission", images_.emission),
                reads("Placements", lit ? light.placements : images_.records),
                reads("light_irradiance", lit ? light.irradiance : images_.emission),
                reads("light_direction", lit ? light.direction : images_.emission),
                reads("Lights", lit ? volumes_.lights() : images_.records)};
    }
    void set(PathPush& push) const override {
        push.volume_count = images_.count;
        push.proxy = sharp() ? kSharpInterfaces : parameters_.whole("proxy");
        if (!volumes_.lit()) return;
        push.light_count = volumes_.light_count();
    }

    void march(const PathPass& pass, const Buffer& entering, const Buffer& next, const Buffer& ended) const override {
        std::vector<Constant> constants = pass.constants;
        for (const Constant& constant :
             {Constant{"kIntegrator", parameters_.whole("integrator")}, Constant{"kAbsorbs", images_.absorbs},
              Constant{"kBoundaries", images_.reflects}, Constant{"kScatters", images_.scatters},
              Constant{"kEmits", images_.emits}, Constant{"kDisperses", images_.disperses},
              Constant{"kSurfacesInside", pass.frame.scene.object_count > 0},
              Constant{"kOverlapping", images_.overlapping},
              Constant{"kStep", std::bit_cast<std::uint32_t>(float(parameters_["step"]))},
              Constant{"kMostSteps", parameters_.whole("max-steps")}, Constant{"kLit", volumes_.lit()},
              Constant{"kCubic", parameters_.whole("interpolation")}})
            constants.push_back(constant);
        const std::vector<Binding> group = bindings();
        pass.recorder.compute_indirect(
            pass.frame.workspace.compute(shaders::march_rays_comp, constants),
            {pass.frame.bindings(), pass.bindings, all_of(group), reads("PixelList", entering),
             updates("NextList", next), updates("EndedList", ended)},
            pass.push, entering);
    }

    ShaderCode follow_shader() const override {
        return sharp() ? shaders::follow_held_paths_comp : shaders::follow_paths_comp;
    }
    ShaderCode end_shader() const override {
        return volumes_.lit() ? shaders::end_lit_paths_comp : shaders::end_paths_comp;
    }

private:
    static constexpr std::uint32_t kSharpInterfaces = 2;  // of visibility_bindings.glsl
    bool sharp() const { return parameters_["interfaces"] != 0.0; }

    const SceneVolumes& volumes_;
    const VolumeImages& images_;
    const ParameterValues& parameters_;
};

SceneVolumes& volumes_of(const GpuScene& scene) { return static_cast<SceneVolumes&>(*scene.volumes); }

void prepare(const Preparation& preparation, const ParameterValues& parameters) {
    prepare_paths(preparation, parameters);
    GpuScene& gpu_scene = preparation.gpu_scene;
    if (!gpu_scene.volumes) gpu_scene.volumes = std::make_unique<SceneVolumes>(preparation.device);
    const double given = parameters["voxelize"];
    const bool wanted = given >= 0.0 ? given > 0.0 : preparation.scene.volume_objects.empty();
    std::optional<VoxelSettings> voxels;
    // With sharp interfaces glass of one index is what its surfaces are.
    if (wanted && parameters["interfaces"] == 0.0 && !gpu_scene.refractive.empty())
        voxels = VoxelSettings{.resolution = parameters.whole("voxels"), .smoothing = float(parameters["smoothing"])};
    volumes_of(gpu_scene).bring_up_to_date(preparation.scene, gpu_scene, voxels);
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    SceneVolumes& scene_volumes = volumes_of(frame.scene);
    Frame lit = frame;
    if (scene_volumes.lit()) {
        scene_volumes.light(recorder, frame.workspace,
                            {.kept = parameters["kept-light"] != 0.0 ? KeptLight::kSum : KeptLight::kBrightest,
                             .step = float(parameters["light-step"]),
                             .keep_folds = parameters["folds"] != 0.0,
                             .capacity = parameters.whole("patches"),
                             .slices = parameters.whole("light-slices"),
                             .reflections = parameters.whole("reflected-light"),
                             .shown_spacing = frame.front_exposure ? float(parameters["wavefront-spacing"]) : 0.0f});
        recorder.when_done([&source = layers.source, &scene_volumes] {
            if (scene_volumes.must_repeat()) source.repeat();
        });
        lit.photons = &scene_volumes.photons();
    }
    const SurfaceMap map = layers.source.map_meshes(recorder, frame, parameters.whole("map-resolution"));
    const Volumes volumes(scene_volumes, parameters);
    return follow_paths(recorder, lit, layers, map, parameters, &volumes);
}

void draw_light(Recorder& recorder, const Frame& frame, const Opaque& opaque, const GpuImage& radiance) {
    const SceneVolumes& volumes = volumes_of(frame.scene);
    if (!volumes.lit()) throw Error("view wavefront: the scene has no volumes");
    draw_wavefronts(recorder, frame, volumes.light_volumes().shown, opaque.depth, radiance, *frame.front_exposure);
}

void report(const GpuScene& scene, std::vector<std::string>& warnings) {
    const std::vector<std::string> lines = volumes_of(scene).warnings();
    warnings.insert(warnings.end(), lines.begin(), lines.end());
}

}  // namespace

constexpr Technique kIhrke2007{
    .info = {.name = "ihrke-2007",
             .summary = "curved rays through volumes in which the index of refraction varies",
             .source = {"Ivo Ihrke, Gernot Ziegler, Art Tevs, Christian Theobalt, Marcus Magnor, Hans-Peter Seidel",
                        "Eikonal Rendering: Efficient Light Transport in Refractive Objects",
                        "ACM Transactions on Graphics 26(3)", 2007, "3, 4.1, 5.3"},
             .parameters = kParameters,
             .many_media = true,
             .whole_scene = true,
             .volumes = true},
    .programs = {&shaders::begin_paths_comp, &shaders::begin_at_eye_comp, &shaders::march_rays_comp,
                 &shaders::follow_held_paths_comp, &shaders::follow_paths_comp, &shaders::end_lit_paths_comp},
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers"); },
    .prepare = prepare,
    .record = record,
    .draw_light = draw_light,
    .report = report,
};

}  // namespace pellucid
