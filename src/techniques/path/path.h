#pragma once

#include "techniques/technique.h"

namespace pellucid {

extern const Technique kPath;

}  // namespace pellucid
