#pragma once

#include "techniques/truth.h"

namespace pellucid {

extern const Truth kPath;

}  // namespace pellucid
