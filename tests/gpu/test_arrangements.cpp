// Techniques that draw whole scenes on random arrangements of balls and boxes, against closed formulas.
#include "closed_form/survey.h"
#include "gpu/gpu_test.h"

namespace pellucid::test {
namespace {

/// Each technique learns from one arrangement how much room paths need, so one renderer draws them all.
TraceArrangement tracing_with(Renderer& renderer, const char* technique, const ParameterMap& parameters = {}) {
    return [&renderer, technique, parameters](const Scene& scene, const Camera& camera, std::uint32_t size) {
        renderer.set_scene(scene);
        renderer.set_camera(camera);
        RenderSettings settings;
        settings.width = settings.height = size;
        settings.technique = technique;
        settings.parameters = parameters;
        settings.paths = true;
        return renderer.render(settings).paths;
    };
}

class Arrangements : public TechniqueTest {};
INSTANTIATE_TEST_SUITE_P(All, Arrangements,
                         testing::Values("visibility-layers", "visibility-cube", "ray-tracing", "ray-tracing-cpu"),
                         technique_test_name);

TEST_P(Arrangements, AgreesWithClosedForms) { expect_agreement(tracing_with(renderer(), GetParam()), 64); }
TEST_P(Arrangements, AgreesOnEveryKind) { expect_agreement_on_kinds(tracing_with(renderer(), GetParam()), 64); }

class ArrangementsOfVolumes : public RendererTest {};

// As surfaces: voxels have neither of a scene's details.
TEST_F(ArrangementsOfVolumes, AgreesWithClosedForms) {
    expect_agreement(tracing_with(renderer(), "ihrke-2007", {{"voxelize", 0}}), 64, Transmittance::kIsFree);
}

}  // namespace
}  // namespace pellucid::test
