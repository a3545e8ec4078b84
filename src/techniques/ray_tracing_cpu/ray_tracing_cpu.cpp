// The paths of visibility-layers, whose surfaces Embree finds on the host.
#include "techniques/ray_tracing_cpu/ray_tracing_cpu.h"

#include "techniques/visibility_layers/visibility_layers.h"

#include <algorithm>
#include <array>
#include <memory>

namespace pellucid {
namespace {

constexpr NamedValue kRebuildNames[] = {{0, "kept", "and refitted where vertices have moved"},
                                        {1, "refitted", "in every frame, to measure that"}};
constexpr ParameterInfo kRebuild{"rebuild", "", 0, 0, 1, true, "what becomes of the hierarchy", kRebuildNames};

/// Those of paths, but for how many surfaces a dispatch takes them to: that is one, as the host searches in between.
constexpr auto kParameters = [] {
    std::array<ParameterInfo, kPathParameters.size()> all{};
    all.back() = kRebuild;
    std::copy_if(kPathParameters.begin(), kPathParameters.end(), all.begin(),
                 [](const ParameterInfo& parameter) { return parameter.name != "surfaces-per-pass"; });
    return all;
}();

HostFinder& finder_of(const GpuScene& scene) { return static_cast<HostFinder&>(*scene.host_finder); }

void prepare(const Preparation& preparation, const ParameterValues& parameters) {
    prepare_paths(preparation, parameters);
    const GpuScene& scene = preparation.gpu_scene;
    host_finder_of(preparation)
        .bring_up_to_date(preparation.device, preparation.scene, scene, parameters["rebuild"] != 0.0);
}

Refraction record(Recorder& recorder, const Frame& frame, const Layers& layers, const ParameterValues& parameters) {
    HostFinder& finder = finder_of(frame.scene);
    if (parameters["rebuild"] != 0.0) {
        const Recorder::Scope scope(recorder, "refit");
        recorder.on_host([&finder] {
            finder.refit();
            return true;
        });
    }
    return follow_paths(recorder, frame, layers, finder, parameters);
}

}  // namespace

constexpr Technique kRayTracingCpu{
    .info = {.name = "ray-tracing-cpu",
             .summary = "every interface, found by Embree on the processor, on devices that are one",
             .source = {"Ingo Wald, Sven Woop, Carsten Benthin, Gregory S. Johnson, Manfred Ernst",
                        "Embree: A Kernel Framework for Efficient CPU Ray Tracing",
                        "ACM Transactions on Graphics 33(4)", 2014, "4"},
             .parameters = kParameters,
             .many_media = true,
             .whole_scene = true,
             .recordable = false},
    .programs = kPathPrograms,
    .lacking = [](const Device& device) -> std::string {
        return device.is_cpu() ? "" : "a device that is a processor (a software driver)";
    },
    .layer_count = [](const ParameterValues& parameters) { return parameters.whole("layers"); },
    .prepare = prepare,
    .record = record,
};

}  // namespace pellucid
