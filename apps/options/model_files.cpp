#include "options/model_files.h"

#include <fmt/format.h>

#include <algorithm>

namespace pellucid::cli {

std::filesystem::path ModelFolder::find(const Model& model) {
    std::error_code ignored;
    for (const char* file : model.files) {
        if (file && !folder_.empty() && std::filesystem::is_regular_file(folder_ / file, ignored))
            return folder_ / file;
    }
    if (model.installed && std::filesystem::is_regular_file(model.installed, ignored)) return model.installed;
    const std::string warning =
        fmt::format("{} is left out: {} has no {}", model.name,
                    folder_.empty() ? "there is no --models DIR that" : "the folder of --models", model.files.front());
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end()) warnings_.push_back(warning);
    return {};
}

}  // namespace pellucid::cli
