#pragma once

#include "techniques/technique.h"

namespace pellucid {

extern const Technique kReference;

inline constexpr ParameterInfo kMaxEvents{.name = "events",
                                          .unit = "",
                                          .default_value = 16,
                                          .minimum = 1,
                                          .maximum = 4095,
                                          .whole = true,
                                          .doc = "interface events that exact paths may have"};

/// Traces one exact path per pixel of `frame.traced` on the CPU, up to `max_events` events, and
/// brings the result to the device.
Refraction upload_exact_paths(const Frame& frame, std::uint32_t max_events);

}  // namespace pellucid
