#pragma once

#include "sequence/frames.h"

#include <string>
#include <vector>

namespace pellucid::sequence {

/// A batch script for `sbatch`: one array job with a task for each of `tasks`, which renders its frames in this folder.
/// `arguments`: of `pellucid sequence`, without --frames. `program`: used unless $PELLUCID names another.
std::string slurm_script(const std::string& program, const std::vector<std::string>& arguments,
                         const std::vector<Frames>& tasks);

}  // namespace pellucid::sequence
