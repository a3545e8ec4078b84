// Techniques that draw whole scenes on random arrangements of balls and boxes, against closed formulas.
#include "closed_form/survey.h"
#include "gpu/gpu_test.h"

namespace pellucid::test {
namespace {

/// Each technique learns from one arrangement how much room paths need, so one renderer draws them all.
class Arrangements : public RendererTest {
protected:
    TraceArrangement with(const std::string& technique, const ParameterMap& parameters = {}) {
        const std::string lacking = renderer().lacking(find_technique(technique));
        if (!lacking.empty()) return {};
        return [this, technique, parameters](const Scene& scene, const Camera& camera, std::uint32_t size) {
            renderer().set_scene(scene);
            renderer().set_camera(camera);
            RenderSettings settings;
            settings.width = settings.height = size;
            settings.technique = technique;
            settings.parameters = parameters;
            settings.paths = true;
            return renderer().render(settings).paths;
        };
    }
};

TEST_F(Arrangements, VisibilityLayersAgreesWithClosedForms) { expect_agreement(with("visibility-layers"), 64); }
TEST_F(Arrangements, VisibilityCubeAgreesWithClosedForms) { expect_agreement(with("visibility-cube"), 64); }
TEST_F(Arrangements, RayTracingCpuAgreesWithClosedForms) {
    const TraceArrangement trace = with("ray-tracing-cpu");
    if (!trace) GTEST_SKIP() << "the device is no CPU";
    expect_agreement(trace, 64);
}

// As surfaces: voxels have neither of a scene's details.
TEST_F(Arrangements, IhrkeAgreesWithClosedForms) {
    expect_agreement(with("ihrke-2007", {{"voxelize", 0}}), 64, Transmittance::kIsFree);
}

TEST_F(Arrangements, VisibilityLayersAgreesOnEveryKind) { expect_agreement_on_kinds(with("visibility-layers"), 64); }
TEST_F(Arrangements, VisibilityCubeAgreesOnEveryKind) { expect_agreement_on_kinds(with("visibility-cube"), 64); }
TEST_F(Arrangements, RayTracingCpuAgreesOnEveryKind) {
    const TraceArrangement trace = with("ray-tracing-cpu");
    if (!trace) GTEST_SKIP() << "the device is no CPU";
    expect_agreement_on_kinds(trace, 64);
}

}  // namespace
}  // namespace pellucid::test
