// Frames of a sequence: their numbers and files, keys, and claims of many processes.
#include "sequence/frame_claims.h"
#include "sequence/frames.h"
#include "sequence/keyed_text.h"

#include <pellucid/error.h>
#include <pellucid/file.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace pellucid::sequence {
namespace {

using testing::ElementsAre;

TEST(Sequence, NumbersOfFrames) {
    EXPECT_THAT(parse_frames("", "7"), ElementsAre(7));
    EXPECT_THAT(parse_frames("", "8..10,3,9,4..4"), ElementsAre(3, 4, 8, 9, 10));
    EXPECT_EQ(format_frames(parse_frames("", "8..10,3,9,4..4,20")), "3..4,8..10,20");
    for (const char* wrong : {"", "a", "1..", "..2", "3..2", "-1..2", "1.5", "1,", "1...3", "0..99999999", "1 ..2"})
        EXPECT_THROW(parse_frames("--frames", wrong), Error) << wrong;
}

TEST(Sequence, TasksShareFramesEvenly) {
    const std::vector<Frames> tasks = split_frames(parse_frames("", "0..9,20"), 4);
    EXPECT_THAT(tasks, ElementsAre(Frames{0, 1}, Frames{2, 3, 4}, Frames{5, 6, 7}, Frames{8, 9, 20}));
    EXPECT_EQ(split_frames(parse_frames("", "0..2"), 10).size(), 3u);
}

TEST(Sequence, FilesOfFrames) {
    EXPECT_EQ(FilePattern("", "out/a-###.b.png").file(7), "out/a-007.b.png");
    EXPECT_EQ(FilePattern("", "#.exr").file(12345), "12345.exr");
    EXPECT_EQ(FilePattern("", "out/a-##.png").beside("sequence", ".json"), "out/a-sequence.json");
    for (const char* wrong : {"a.png", "a-#-#.png", "a##/b.png"})
        EXPECT_THROW(FilePattern("--output", wrong), Error) << wrong;
}

double first_number(const std::string& text) { return std::stod(text.substr(text.find(':') + 1)); }

TEST(Sequence, KeysAreMetAndNeverExceeded) {
    const KeyedText keys("", {"10=orbit:0,15,4", "20=orbit:90,80,4", "40=orbit:90,15,4", "50=orbit:100,15,3"});
    EXPECT_EQ(keys.at(0), keys.at(10));
    EXPECT_EQ(keys.at(10), "orbit:0,15,4");
    EXPECT_EQ(keys.at(20), "orbit:90,80,4");
    EXPECT_EQ(keys.at(99), "orbit:100,15,3");
    EXPECT_EQ(first_number(keys.at(30)), 90.0) << "flat between equal keys";
    double last = -1.0;
    for (long frame = 10; frame <= 20; ++frame) {
        const double now = first_number(keys.at(frame));
        EXPECT_GE(now, last);
        EXPECT_LE(now, 90.0);
        last = now;
    }
    const KeyedText turn("", {"0=orbit:0,15,4", "60=orbit:360,15,4"});
    for (long frame = 0; frame <= 60; ++frame) EXPECT_NEAR(first_number(turn.at(frame)), 6.0 * double(frame), 1e-9);
}

TEST(Sequence, WrongKeys) {
    for (const std::vector<std::string>& wrong : {std::vector<std::string>{"orbit:0,15,4"},
                                                  {"0=orbit"},
                                                  {"0=orbit:a,b,c"},
                                                  {"0..2=orbit:0,15,4"},
                                                  {"0=orbit:0,15,4", "0=orbit:1,15,4"},
                                                  {"0=sun:0,15", "5=lamp:0,15"},
                                                  {"0=orbit:0,15,4", "5=orbit:0,15,4,0,0,0"}})
        EXPECT_THROW(KeyedText("--camera-at", wrong), Error) << wrong.front();
}

/// A folder of a sequence's frames, which counts how often each has been finished.
class Folder {
public:
    explicit Folder(std::size_t frames) : made_(frames) { std::filesystem::create_directories(path_); }
    ~Folder() { std::filesystem::remove_all(path_); }

    std::filesystem::path lock() const { return path_ / "lock"; }
    std::filesystem::path file(long frame) const { return path_ / fmt::format("{}.png", frame); }
    void finish(long frame) {
        ++made_[std::size_t(frame)];
        write_text_file(file(frame), "frame");
    }
    int made(long frame) const { return made_[std::size_t(frame)]; }
    Frames missing() const {
        Frames missing;
        for (long frame = 0; frame < long(made_.size()); ++frame)
            if (!is_written(file(frame))) missing.push_back(frame);
        return missing;
    }

private:
    const std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / fmt::format("pellucid-sequence-{}", std::random_device()());
    std::vector<std::atomic<int>> made_;
};

/// A task of a cluster as it may end: 5% die in the middle of a frame, 1% hold a frame for long, so that the scheduler starts them
/// again while they live. True if it has done its frames.
bool run_task(const Frames& frames, Folder& folder, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform;
    const bool dies = uniform(random) < 0.05, lingers = uniform(random) < 0.01;
    FrameClaims claims(folder.lock());
    for (const long frame : frames) {
        claims.claim_in_turn(frame);
        if (is_written(folder.file(frame))) continue;
        if (dies) {  // its claim goes with it, half a file stays
            write_text_file(folder.file(frame).parent_path() / fmt::format(".{}.part-1-0.png", frame), "half");
            return false;
        }
        if (lingers)
            for (int i = 0; i < 1000; ++i) std::this_thread::yield();
        folder.finish(frame);
        claims.release(frame);
    }
    return true;
}

TEST(Sequence, NoFrameOfTenThousandTasksIsLostOrMadeTwice) {
    constexpr std::size_t kTasks = 10000, kFrames = 12000, kWorkers = 8;
    Folder folder(kFrames);
    std::size_t rounds = 0, started = 0, died = 0;
    for (Frames missing = folder.missing(); !missing.empty(); missing = folder.missing(), ++rounds) {
        ASSERT_LT(rounds, 20u);
        const std::vector<Frames> tasks = split_frames(missing, kTasks);
        std::deque<std::size_t> queue(tasks.size());
        std::iota(queue.begin(), queue.end(), 0);
        // One in twenty is started twice, as Slurm does with a node that it has lost from sight.
        for (std::size_t i = 0; i < tasks.size(); i += 20) queue.push_back(i);
        std::shuffle(queue.begin(), queue.end(), std::mt19937(unsigned(rounds)));
        std::mutex mutex;
        std::vector<std::thread> workers;
        for (std::size_t worker = 0; worker < kWorkers; ++worker) {
            workers.emplace_back([&, random = std::mt19937(unsigned(100 * rounds + worker))]() mutable {
                for (;;) {
                    std::size_t task = 0;
                    {
                        const std::lock_guard lock(mutex);
                        if (queue.empty()) return;
                        task = queue.front();
                        queue.pop_front();
                        ++started;
                    }
                    const bool done = run_task(tasks[task], folder, random);
                    const std::lock_guard lock(mutex);
                    died += done ? 0 : 1;
                }
            });
        }
        for (std::thread& worker : workers) worker.join();
    }
    for (long frame = 0; frame < long(kFrames); ++frame) ASSERT_EQ(folder.made(frame), 1) << frame;
    std::vector<std::filesystem::path> files;
    for (long frame = 0; frame < long(kFrames); ++frame) files.push_back(folder.file(frame));
    remove_leftovers(folder.lock().parent_path(), files);
    for (const auto& entry : std::filesystem::directory_iterator(folder.lock().parent_path()))
        EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
    EXPECT_GT(died, 300u);
    EXPECT_GT(rounds, 1u);
    RecordProperty("tasks", int(started));
    fmt::print("{} tasks in {} rounds, {} died\n", started, rounds, died);
}

}  // namespace
}  // namespace pellucid::sequence
