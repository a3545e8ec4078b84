#pragma once

#include <pellucid/error.h>

#include <cstddef>
#include <string>
#include <vector>

namespace pellucid::cli {

/// Lets a command that measures several scenes go on past one that cannot be read.
class UnreadScenes {
public:
    /// `scenes`: how many the command has; 0: not known.
    explicit UnreadScenes(std::size_t scenes) : scenes_(scenes) {}

    /// Runs `load`. Returns false, having printed why, where it throws Error; a single scene's Error goes through.
    template <class Load>
    bool read(const std::string& name, Load&& load) {
        try {
            load();
            return true;
        } catch (const Error& error) {
            if (scenes_ == 1) throw;
            add(name, error.what());
            return false;
        }
    }

    /// One line each, for a JSON's warnings.
    const std::vector<std::string>& errors() const { return errors_; }
    /// Throws Error that names the scenes, if there are any. Call it when all else is done.
    void finish() const;

private:
    void add(const std::string& name, const std::string& error);

    std::size_t scenes_;
    std::vector<std::string> names_, errors_;
};

}  // namespace pellucid::cli
