#include "viewer/viewer.h"

#include "viewer/equal_command.h"
#include "viewer/overlay.h"

#include <pellucid/file.h>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <utility>

namespace pellucid::viewer {
namespace {

/// Time after the last change during which the image still counts as moving.
constexpr std::chrono::milliseconds kSettle{200};
constexpr double kPollSeconds = 0.002;  ///< while there is work
constexpr double kMinimizedSeconds = 0.02;
constexpr double kIdleSeconds = 0.5;
constexpr std::size_t kFrameTimes = 120;
constexpr double kLoadingSeconds = 0.03;
constexpr std::chrono::milliseconds kLoadingRedraw{100};

/// The subset of parameters that the technique has; others belong to the technique on the other side of the divider.
ParameterMap own_parameters(const ParameterMap& given, const TechniqueInfo& technique) {
    ParameterMap own;
    for (const ParameterInfo& info : technique.parameters) {
        if (const auto found = given.find(info.name); found != given.end()) own.insert(*found);
    }
    return own;
}

}  // namespace

Viewer::Viewer(const cli::DeviceArguments& device, std::uint32_t width, std::uint32_t height)
    : gpu_(device.device, device.validate), window_(gpu_, "Pellucid", width, height), gui_(gpu_, window_),
      renderer_(gpu_.lent(), device.threads), frames_of_renderer_(renderer_), stage_(renderer_),
      left_(gpu_, frames_of_renderer_), right_(gpu_, frames_of_renderer_) {}

Viewer::~Viewer() {
    try {
        finish_pictures();  // frames in flight write to images that are destroyed before the renderer
    } catch (...) {
        std::fputs("pellucid-view: the last frame failed\n", stderr);
    }
}

void Viewer::attempt(const std::function<void()>& action, const OnFailure& failed) {
    const auto report = [&](const std::string& why) {
        turns_to_draw_ = kLateTurns;
        failed ? failed(why) : panels_.say(why, true);
    };
    try {
        action();
    } catch (const Error& error) {
        report(error.what());
    } catch (const DeviceError& error) {
        report(error.what());
    }
}

void Viewer::undo() {
    if (!document_.undo()) panels_.say("nothing to undo", false);
    turns_to_draw_ = kLateTurns;
}

void Viewer::redo() {
    if (!document_.redo()) panels_.say("nothing to redo", false);
    turns_to_draw_ = kLateTurns;
}

void Viewer::frame() {
    const vk::Extent2D extent = window_.extent();
    if (extent.width == 0 || extent.height == 0) return;
    const OrbitCamera old = document_.look.camera;
    document_.look.file_camera.clear();
    document_.look.camera = framing_orbit(document_.bounds(), extent.width, extent.height, old.fov_deg);
    document_.look.camera.azimuth_deg = old.azimuth_deg;
    document_.look.camera.elevation_deg = old.elevation_deg;
}

void Viewer::inspect(glm::ivec2 pixel) {
    ray_.reset();
    const vk::Extent2D extent = window_.extent();
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= int(extent.width) || pixel.y >= int(extent.height)) return;
    finish_pictures();  // the tracer belongs to the renderer
    ray_ = viewer::inspect(renderer_.tracer(), stage_.scene(), stage_.camera(), glm::uvec2(pixel), extent.width,
                           extent.height);
    turns_to_draw_ = kLateTurns;
}

bool Viewer::moving() const {
    return panels_.playing || input_.dragging() || input_.flying() || Clock::now() - moved_at_ < kSettle;
}

bool Viewer::pictures_still() const {
    return !moving() && seen_ == document_.look && left_.still() && (document_.look.other.empty() || right_.still());
}

bool Viewer::still() const { return !loading() && (window_.extent().width == 0 || pictures_still()); }

void Viewer::advance_animation() {
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(turned_at_, now)).count();
    Look& look = document_.look;
    if (!panels_.playing || !look.animation) return;
    const double duration = document_.animations()[*look.animation].duration_s;
    look.time_s = duration > 0.0 ? std::fmod(look.time_s + seconds * double(panels_.speed), duration) : 0.0;
}

void Viewer::finish_pictures() {
    left_.finish();
    right_.finish();
}

/// Passes all changes to the renderer and the pictures.
void Viewer::update_pictures() {
    const vk::Extent2D extent = window_.extent();
    if (extent.width == 0 || extent.height == 0 || document_.scene_number() == 0) return;
    const Look& look = document_.look;
    if (stage_.apply(document_, [&] { finish_pictures(); })) {
        ++revision_;
        ray_.reset();
    }
    Look seen = look;
    seen.divider = seen_.divider;  // the divider moves over unchanged images
    if (!(seen == seen_) || extent != seen_extent_) {
        moved_at_ = Clock::now();
        if (!changed_at_) changed_at_ = moved_at_;
    }
    seen_ = look;
    seen_extent_ = extent;
    const auto want = [&](Picture& picture, const std::string& technique) {
        RenderSettings settings = settings_of(look, technique, extent.width, extent.height);
        settings.parameters = own_parameters(look.parameters, *renderer_.choose(technique).technique);
        picture.want(settings, moving(), revision_);
    };
    want(left_, look.technique);
    if (!look.other.empty()) want(right_, look.other);
}

/// Takes finished frames. Returns true if there is a new image to show.
bool Viewer::take_pictures() {
    bool another = false;
    for (Picture* picture : {&left_, &right_}) {
        if (!picture->take()) continue;
        ++frames_;
        // Restart the delay when this image appears, so that slow devices show it before the next change.
        if (picture->info().moving) moved_at_ = Clock::now();
        if (picture == &left_) {
            response_to_ = std::exchange(shows_change_of_, std::nullopt);
            frame_times_ms_.push_back(float(picture->info().frame_ms));
            if (frame_times_ms_.size() > kFrameTimes) frame_times_ms_.pop_front();
        }
        // On small devices, showing a sample costs as much as drawing it: show only samples that change the image
        // noticeably.
        const PictureInfo& info = picture->info();
        another |= info.samples_wanted == 1 || std::has_single_bit(info.samples) || info.samples == info.samples_wanted;
    }
    return another;
}

void Viewer::submit_pictures() {
    if (left_.in_flight() || right_.in_flight()) return;
    const auto wait_for_reads = [&] { window_.wait_for_reads(); };
    if (document_.look.other.empty()) {
        left_.submit(wait_for_reads);
        return;
    }
    // Frames accumulate one image at a time. During motion each image has one sample.
    if (moving())
        left_turn_ = !left_turn_;
    else
        left_turn_ = !left_.still();
    (left_turn_ ? left_ : right_).submit(wait_for_reads);
}

/// Redraws the overlay once the image under it has changed and is complete. Returns true if the overlay to show has
/// changed.
bool Viewer::update_overlay() {
    const Look& look = document_.look;
    const bool wanted = !look.overlay.empty() && !moving() && left_.still() && left_.has_image();
    if (!wanted) return std::exchange(overlay_look_, std::nullopt).has_value();
    if (overlay_look_ == look && overlay_revision_ == revision_) return false;
    overlay_look_ = look;
    overlay_revision_ = revision_;
    finish_pictures();
    const vk::Extent2D extent = window_.extent();
    RenderSettings settings = settings_of(look, look.technique, extent.width, extent.height);
    settings.parameters = own_parameters(look.parameters, *renderer_.choose(look.technique).technique);
    window_.wait_for_reads();
    overlay_ = {};
    frames_of_renderer_.restart();  // Renderer::render() overwrites the accumulated samples
    overlay_ = upload(gpu_, draw_overlay(look.overlay, renderer_, stage_.camera(), document_.bounds(), settings));
    return true;
}

std::vector<ShownImage> Viewer::shown_images() const {
    const vk::Extent2D window = window_.extent();
    const Look& look = document_.look;
    std::vector<ShownImage> images;
    if (!left_.has_image()) return images;
    const auto whole = [&](const Picture& picture) {
        if (overlay_look_ && *overlay_.image && &picture == &left_)
            return ShownImage{*overlay_.image, {{0, 0}, overlay_.extent}, {{0, 0}, window}};
        return ShownImage{picture.image(), {{0, 0}, picture.extent()}, {{0, 0}, window}};
    };
    if (look.other.empty() || !right_.has_image()) return {whole(left_)};
    ShownImage left = whole(left_), right = whole(right_);
    const auto part = [&](std::uint32_t width) {
        return std::min(width, std::uint32_t(std::lround(double(look.divider) * width)));
    };
    left.where.extent.width = part(window.width);
    left.from.extent.width = part(left.from.extent.width);
    const std::uint32_t from = part(right.from.extent.width), at = part(window.width);
    right.from = vk::Rect2D{{std::int32_t(from), 0}, {right.from.extent.width - from, right.from.extent.height}};
    right.where = vk::Rect2D{{std::int32_t(at), 0}, {window.width - at, window.height}};
    return {left, right};
}

void Viewer::draw_divider() {
    const Look& look = document_.look;
    if (look.other.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float x = look.divider * size.x;
    list.AddLine({x, 0.0f}, {x, size.y}, IM_COL32(255, 255, 255, 200), 2.0f);
    list.AddText({x + 6.0f, 6.0f}, IM_COL32(255, 255, 255, 220), look.other.c_str());
}

void Viewer::draw_window(Image* capture) {
    window_.draw(
        shown_images(), [&](vk::CommandBuffer commands) { gui_.record(commands); }, capture);
}

std::string Viewer::command_line() {
    const vk::Extent2D extent = window_.extent();
    const EqualCommand command =
        equal_command(document_.look, document_.scene(), document_.how(), extent.width, extent.height);
    std::string text = command.line + "\n";
    for (const std::string& line : command.lacking) text += fmt::format("# lacks {}\n", line);
    return text;
}

void Viewer::save(const Image& image, const char* stem) {
    if (image.pixels.empty()) return;
    std::string file;
    for (int number = 1; file.empty() || std::filesystem::exists(file); ++number)
        file = fmt::format("{}-{}.png", stem, number);
    write_image(file, image);
    panels_.say(fmt::format("saved {}", file), false);
}

void Viewer::grant(const Wishes& wishes) {
    if (!wishes.open.empty()) open(wishes.open);
    if (!wishes.environment.empty()) open_environment(wishes.environment);
    if (wishes.cancel) cancel_loading();
    if (wishes.undo) undo();
    if (wishes.redo) redo();
    if (wishes.frame) frame();
    if (wishes.save) attempt([&] { save(image(), "pellucid"); });
    if (wishes.screenshot) attempt([&] { save(screenshot(), "pellucid-window"); });
    if (wishes.copy_command) {
        glfwSetClipboardString(window_.handle(), command_line().c_str());
        panels_.say("copied: " + command_line(), false);
    }
    if (wishes.close) window_.close();
}

/// Longest wait of a turn for an event, s.
double Viewer::patience_s(bool wait) const {
    if (window_.extent().width == 0) return kMinimizedSeconds;
    if (!wait || turns_to_draw_ > 0 || !pictures_still()) return kPollSeconds;
    if (loading()) return kLoadingSeconds;
    const double change = panels_.seconds_to_change();
    return change >= 0.0 ? std::min(kIdleSeconds, change + 0.01) : kIdleSeconds;
}

void Viewer::turn(bool wait) {
    if (window_.handle_events(patience_s(wait))) turns_to_draw_ = kLateTurns;
    const auto start = Clock::now();
    for (const std::filesystem::path& file : window_.take_dropped()) open(file.string());
    advance_animation();
    if (loading()) take_loaded();

    bool another = input_.flying() || (loading() && start - drawn_at_ > kLoadingRedraw);
    attempt([&] {
        another |= take_pictures();
        update_pictures();
        another |= update_overlay();
        submit_pictures();
        if (changed_at_ && left_.in_flight()) shows_change_of_ = std::exchange(changed_at_, std::nullopt);
    });
    if (another || panels_.seconds_to_change() == 0.0) turns_to_draw_ = std::max(1, turns_to_draw_);
    if (turns_to_draw_ > 0) {
        --turns_to_draw_;
        if (window_.extent().width != 0) draw_and_listen();
    }
    const double turn_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    longest_turn_ms_ = std::max(longest_turn_ms_, turn_ms);
}

/// Draws the window, and executes requests of panels, keys and pointer.
void Viewer::draw_and_listen() {
    drawn_at_ = Clock::now();
    Wishes wishes;
    std::optional<glm::ivec2> pixel;
    gui_.begin_frame();
    panels_.draw(document_,
                 {.renderer = &renderer_,
                  .left = &left_.info(),
                  .right = document_.look.other.empty() ? nullptr : &right_.info(),
                  .frame_times_ms = &frame_times_ms_,
                  .ray = ray_ ? &*ray_ : nullptr,
                  .loading = progress()},
                 wishes);
    if (document_.scene_number() > 0) input_.handle(document_, panels_, wishes, pixel);
    draw_divider();
    if (ray_) draw_ray(*ray_, stage_.camera(), document_.bounds());
    gui_.end_frame();
    draw_window(nullptr);
    if (const auto changed = std::exchange(response_to_, std::nullopt)) note_response(*changed);
    if (!input_.dragging() && !panels_.playing && !loading()) document_.commit();
    grant(wishes);
    if (pixel) attempt([&] { inspect(*pixel); });
}

void Viewer::note_response(Clock::time_point start) {
    response_times_ms_.push_back(std::chrono::duration<float, std::milli>(Clock::now() - start).count());
    if (response_times_ms_.size() > kFrameTimes) response_times_ms_.pop_front();
}

Image Viewer::screenshot() {
    turns_to_draw_ = kLateTurns;
    while (turns_to_draw_ > 0) turn(false);
    Image image;
    if (window_.extent().width != 0) draw_window(&image);
    return image;
}

Image Viewer::image() { return left_.has_image() ? left_.read(gpu_) : Image(); }

}  // namespace pellucid::viewer
