#pragma once

/// Marks exported symbols. All other symbols of a shared libpellucid are hidden.
#define PELLUCID_API __attribute__((visibility("default")))
