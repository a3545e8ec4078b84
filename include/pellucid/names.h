#pragma once

#include <pellucid/api.h>
#include <pellucid/error.h>

#include <span>
#include <string>
#include <string_view>

namespace pellucid {

/// " (did you mean NEAREST?)" with the known name that is nearest to `name` in spelling; empty if none is near.
PELLUCID_API std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

/// "unknown WHAT 'NAME' (did you mean NEAREST?); known: A, B", for the caller to throw.
PELLUCID_API Error unknown_name(std::string_view what, std::string_view name, std::span<const std::string_view> known);

}  // namespace pellucid
