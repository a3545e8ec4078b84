// The exact tracer on random arrangements of balls and boxes, against closed formulas.
#include "closed_form/survey.h"

#include <pellucid/reference.h>

#include <gtest/gtest.h>

namespace pellucid::test {
namespace {

TEST(Arrangements, ExactTracerAgreesWithClosedForms) {
    expect_agreement([](const Scene& scene, const Camera& camera,
                        std::uint32_t size) { return Tracer(scene).exact(camera, {.width = size, .height = size}); },
                     64);
}

TEST(Arrangements, ExactTracerAgreesOnEveryKind) {
    expect_agreement_on_kinds(
        [](const Scene& scene, const Camera& camera, std::uint32_t size) {
            return Tracer(scene).exact(camera, {.width = size, .height = size});
        },
        64);
}

}  // namespace
}  // namespace pellucid::test
