#include "sequence/slurm_script.h"

#include "options/arguments.h"

#include <fmt/format.h>

#include <filesystem>

namespace pellucid::sequence {

std::string slurm_script(const std::string& program, const std::vector<std::string>& arguments,
                         const std::vector<Frames>& tasks) {
    std::string frames, line;
    for (const Frames& task : tasks) frames += fmt::format("    {}\n", format_frames(task));
    for (const std::string& argument : arguments) line += " " + cli::shell_quoted(argument);
    return fmt::format(R"(#!/bin/bash
#SBATCH --job-name=pellucid
#SBATCH --array=0-{}
#SBATCH --requeue
# Frames of each task of the array, for 'sbatch'. Without Slurm:
#   seq 0 {} | xargs -P 8 -I{{}} env SLURM_ARRAY_TASK_ID={{}} bash THIS_FILE
frames=(
{})
cd {} || exit 1
exec "${{PELLUCID:-{}}}" sequence{} --frames "${{frames[$SLURM_ARRAY_TASK_ID]}}"
)",
                       tasks.size() - 1, tasks.size() - 1, frames,
                       cli::shell_quoted(std::filesystem::current_path().string()), program, line);
}

}  // namespace pellucid::sequence
