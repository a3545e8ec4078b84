#include "report/report_folder.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

namespace pellucid {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& cause) {
    throw Error(one_line(file.string() + ": " + cause));
}

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine =
    "The files of a Pellucid report. The next report in this folder replaces these and no others.";

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder)) {
        fail(folder, error ? "cannot make the folder: " + error.message() : "is a file, not a folder");
    }
}

/// True if `name` lies inside the folder. Files outside are never removed, whatever the list contains.
bool stays_inside(const fs::path& name) {
    return !name.empty() && name.is_relative() &&
           std::none_of(name.begin(), name.end(), [](const fs::path& part) { return part == ".."; });
}

/// The names on the list; empty if there is no list.
std::vector<std::string> read_list(const fs::path& file) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(file, error))) return {};
    std::ifstream stream(file);
    std::string line;
    if (!std::getline(stream, line) || line != kFirstLine) {
        fail(file, "is not the file list of a report; choose another folder");
    }
    std::vector<std::string> names;
    while (std::getline(stream, line)) {
        if (stays_inside(line)) names.push_back(line);
    }
    return names;
}

void remove_file(const fs::path& file) {
    std::error_code error;
    if (fs::is_directory(fs::symlink_status(file, error))) return;  // not a file of the report any more
    fs::remove(file, error);
    if (error && error != std::errc::not_a_directory) fail(file, "cannot remove: " + error.message());
}

}  // namespace

ReportFolder::ReportFolder(const fs::path& path) : path_(path) {
    make_folder(path);
    const fs::path list = path / kList;
    check_writable(list);
    for (const std::string& name : read_list(list)) {
        remove_file(path / name);
        std::error_code not_empty;
        if (const fs::path folder = fs::path(name).parent_path(); !folder.empty()) fs::remove(path / folder, not_empty);
    }
    write_text_file(list, std::string(kFirstLine) + "\n");
    list_.open(list, std::ios::app);
}

fs::path ReportFolder::claim(const std::string& name) {
    const fs::path file = path_ / name;
    if (has(name)) fail(file, "is in the way, and not of an older report; move it or choose another folder");
    make_folder(file.parent_path());
    list_ << name << std::endl;  // on disk before the file itself
    if (!list_) fail(path_ / kList, "cannot write");
    return file;
}

bool ReportFolder::has(const std::string& name) const {
    std::error_code error;
    return fs::exists(fs::symlink_status(path_ / name, error));
}

}  // namespace pellucid
