#include "render/measured_techniques.h"

#include "bake/bake_cache.h"

#include <pellucid/error.h>
#include <pellucid/file.h>
#include <pellucid/renderer.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <mutex>

namespace pellucid {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kSize = 256;
constexpr int kRounds = 5;

/// Time of one frame, ms, by the clock, because part of the work runs on the host.
double time_frame(Renderer& renderer, std::string_view technique) {
    RenderSettings settings;
    settings.width = settings.height = kSize;
    settings.technique = technique;
    const auto start = Clock::now();
    renderer.render(settings);
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Least time of each technique over kRounds rounds after a warm-up: other load only adds time.
nlohmann::json measure(const DeviceOptions& options, std::span<const std::string_view> techniques) {
    DeviceOptions plain = options;
    plain.validation = false;
    plain.threads = 0;
    Renderer renderer(plain);
    renderer.set_scene(load_scene("shape:knot"));
    nlohmann::json least;
    for (int round = 0; round <= kRounds; ++round) {
        for (const std::string_view technique : techniques) {
            const double ms = time_frame(renderer, technique);
            nlohmann::json& best = least[std::string(technique)];
            if (round > 0) best = best.is_null() ? ms : std::min(ms, best.get<double>());
        }
    }
    return least;
}

/// Stored times of all devices; empty if the file is missing or unreadable.
nlohmann::json read_kept(const std::filesystem::path& file) {
    std::ifstream stream(file);
    nlohmann::json kept = nlohmann::json::parse(stream, nullptr, false);
    return kept.is_object() ? kept : nlohmann::json::object();
}

/// Stores the times. An unwritable folder is not an error: later processes measure again.
void write_kept(const std::filesystem::path& file, const nlohmann::json& kept) {
    try {
        std::filesystem::create_directories(file.parent_path());
        write_text_file(file, kept.dump(1) + '\n');
    } catch (const Error&) {
    } catch (const std::filesystem::filesystem_error&) {
    }
}

bool has_all(const nlohmann::json& times, std::span<const std::string_view> techniques) {
    return times.is_object() && std::all_of(techniques.begin(), techniques.end(), [&](std::string_view technique) {
               const auto found = times.find(std::string(technique));
               return found != times.end() && found->is_number();
           });
}

}  // namespace

std::vector<double> measured_times(const DeviceInfo& device, const DeviceOptions& options,
                                   std::span<const std::string_view> techniques) {
    static std::mutex mutex;
    static nlohmann::json kept = nlohmann::json::object();  // used if no folder is writable
    const std::lock_guard lock(mutex);
    const std::string key = fmt::format("{}, {}, pellucid {}", device.name, device.driver, version());
    const std::filesystem::path folder = bake::default_cache_folder();
    const std::filesystem::path file = folder / "presets.json";
    if (!has_all(kept[key], techniques) && !folder.empty()) kept.update(read_kept(file));
    if (!has_all(kept[key], techniques)) {
        if (!kept[key].is_object()) kept[key] = nlohmann::json::object();
        kept[key].update(measure(options, techniques));
        if (!folder.empty()) write_kept(file, kept);
    }
    std::vector<double> times;
    for (const std::string_view technique : techniques)
        times.push_back(kept[key][std::string(technique)].get<double>());
    return times;
}

}  // namespace pellucid
