#include <pellucid/refracted_path.h>

#include <array>

namespace pellucid {

std::string_view status_name(Status status) {
    constexpr std::array<std::string_view, kStatusCount> kNames = {"ok", "missing_layer", "left_screen", "step_limit",
                                                                   "event_limit"};
    return kNames.at(std::size_t(status));
}

}  // namespace pellucid
