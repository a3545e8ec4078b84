#include "techniques/reference/reference.h"

namespace pellucid {
namespace {

constexpr ParameterInfo kParameters[] = {kMaxEvents};

}  // namespace

constexpr Truth kReference{
    .info = {.name = "reference",
             .summary =
                 "exact refraction, traced on the CPU through the triangles: what the others are measured against",
             .source = {},
             .parameters = kParameters,
             .reference = true,
             .many_media = true,
             .recordable = false},
};

}  // namespace pellucid
