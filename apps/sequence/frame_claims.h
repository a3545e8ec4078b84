#pragma once

#include <filesystem>
#include <vector>

namespace pellucid::sequence {

/// Which process renders a frame, for processes that share a folder, on one machine or several. A claim is a lock on one byte of
/// a file, which the system drops when the process ends, however it does.
class FrameClaims {
public:
    /// Opens the file of locks, which stays. Throws Error if it cannot be made.
    explicit FrameClaims(const std::filesystem::path& file);
    ~FrameClaims();
    FrameClaims(const FrameClaims&) = delete;
    FrameClaims& operator=(const FrameClaims&) = delete;

    /// False if another process has the frame. True without a lock where the file system has none: see has_locks().
    bool claim(long frame);
    /// As claim(), but waits until the frame is free.
    void claim_in_turn(long frame);
    void release(long frame);
    /// False after a claim that the file system could not lock. Frames may then be rendered twice, with the same result.
    bool has_locks() const { return has_locks_; }

private:
    bool lock(int command, short type, long frame);

    std::filesystem::path path_;
    int file_ = -1;
    bool has_locks_ = true;
};

/// Removes half-written copies, which killed processes left, of those `files` in `folder` that have been written since.
void remove_leftovers(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files);

}  // namespace pellucid::sequence
