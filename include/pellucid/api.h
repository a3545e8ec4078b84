#pragma once

/// Marks what the library exports. All other symbols of a shared libpellucid are hidden.
#define PELLUCID_API __attribute__((visibility("default")))
