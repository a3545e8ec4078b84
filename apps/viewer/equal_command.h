#pragma once

#include "options/options.h"
#include "viewer/look.h"

#include <string>
#include <vector>

namespace pellucid::viewer {

/// The `pellucid render` command that reproduces an image.
struct EqualCommand {
    std::string line;                  ///< shell command; writes image.png
    std::vector<std::string> lacking;  ///< parts of the look that no option of the command expresses; one line each
};

/// `scene`: as in its file. `how`: its load options.
EqualCommand equal_command(const Look& look, const Scene& scene, const cli::SceneArguments& how, std::uint32_t width,
                           std::uint32_t height);

/// Quotes `text` as one word of a POSIX shell.
std::string shell_word(const std::string& text);

}  // namespace pellucid::viewer
