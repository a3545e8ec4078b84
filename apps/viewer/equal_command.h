#pragma once

#include "options/options.h"
#include "viewer/look.h"

#include <string>
#include <vector>

namespace pellucid::viewer {

/// The `pellucid render` command that draws an image again.
struct EqualCommand {
    std::string line;                  ///< for a shell; writes image.png
    std::vector<std::string> lacking;  ///< what of the look no option of the command says; one line each
};

/// `scene`: as its file has it. `how`: the options that it was loaded with.
EqualCommand equal_command(const Look& look, const Scene& scene, const cli::SceneArguments& how, std::uint32_t width,
                           std::uint32_t height);

/// `text` as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace pellucid::viewer
