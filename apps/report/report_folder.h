#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace pellucid {

/// A folder whose files are partly ours. A list in it, kList, names those that are, so that the next report
/// replaces them and touches nothing else. A name is on the list before its file is written: a killed run leaves
/// no picture that its successor would not know.
class ReportFolder {
public:
    static constexpr const char* kList = "pellucid-report.txt";

    /// Makes `path`, and its parents, where missing, and removes the files of an older list, in its order. Throws
    /// Error naming the file if that fails, or if a file called kList is no such list.
    explicit ReportFolder(const std::filesystem::path& path);

    /// Path of `name` ('/' separates folders, which are made), after it was put on the list.
    /// Throws Error if there is something of that name that was not ours.
    std::filesystem::path claim(const std::string& name);

    /// Path of `name`.
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    /// Is there anything called `name`?
    bool has(const std::string& name) const;

private:
    std::filesystem::path path_;
    std::ofstream list_;
};

}  // namespace pellucid
