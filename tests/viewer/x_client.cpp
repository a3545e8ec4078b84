// Uses the window of the viewer as a user's X server does: looks at its pixels, presses keys, moves the pointer.
//
//   x_client capture TITLE FILE.png     what the window shows
//   x_client keys TITLE KEYCODE...      presses all of the keys together
//   x_client drag TITLE X0 Y0 X1 Y1     with the left button
//   x_client size TITLE W H             resizes the window
#include <pellucid/image.h>

#include <fmt/format.h>
#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

template <class Reply>
std::unique_ptr<Reply, decltype(&std::free)> owned(Reply* reply) {
    if (reply == nullptr) throw std::runtime_error("the X server did not answer");
    return {reply, &std::free};
}

class Display {
public:
    Display() : connection_(xcb_connect(nullptr, nullptr)) {
        if (xcb_connection_has_error(connection_)) throw std::runtime_error("no X display");
        screen_ = xcb_setup_roots_iterator(xcb_get_setup(connection_)).data;
    }
    ~Display() { xcb_disconnect(connection_); }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    /// The first window whose title has `title` in it.
    xcb_window_t find(const std::string& title) const {
        if (const auto found = find_below(screen_->root, title)) return *found;
        throw std::runtime_error(fmt::format("no window '{}'", title));
    }

    pellucid::Image capture(xcb_window_t window) const {
        const auto size = owned(xcb_get_geometry_reply(connection_, xcb_get_geometry(connection_, window), nullptr));
        const auto image = owned(xcb_get_image_reply(
            connection_,
            xcb_get_image(connection_, XCB_IMAGE_FORMAT_Z_PIXMAP, window, 0, 0, size->width, size->height, ~0u),
            nullptr));
        const std::uint8_t* bgrx = xcb_get_image_data(image.get());
        pellucid::Image picture(size->width, size->height, 3);
        if (std::size_t(xcb_get_image_data_length(image.get())) < picture.pixels.size() / 3 * 4)
            throw std::runtime_error("the window has not 32 bits a pixel");
        for (std::size_t i = 0; i < picture.pixels.size() / 3; ++i)
            for (std::size_t c = 0; c < 3; ++c) picture.pixels[3 * i + c] = float(bgrx[4 * i + 2 - c]) / 255.0f;
        return picture;
    }

    void move_pointer(xcb_window_t window, int x, int y) const {
        const auto at = owned(xcb_translate_coordinates_reply(
            connection_,
            xcb_translate_coordinates(connection_, window, screen_->root, std::int16_t(x), std::int16_t(y)), nullptr));
        xcb_test_fake_input(connection_, XCB_MOTION_NOTIFY, 0, XCB_CURRENT_TIME, screen_->root, at->dst_x, at->dst_y,
                            0);
        sync();
    }
    void button(bool down) const { fake(down ? XCB_BUTTON_PRESS : XCB_BUTTON_RELEASE, 1); }
    /// Presses the keys one after the other and releases them in the other order.
    void keys(xcb_window_t window, const std::vector<int>& codes) const {
        xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, window, XCB_CURRENT_TIME);
        for (auto code = codes.begin(); code != codes.end(); ++code) {
            fake(XCB_KEY_PRESS, std::uint8_t(*code));
            pause();
        }
        for (auto code = codes.rbegin(); code != codes.rend(); ++code) {
            fake(XCB_KEY_RELEASE, std::uint8_t(*code));
            pause();
        }
    }
    void resize(xcb_window_t window, std::uint32_t width, std::uint32_t height) const {
        const std::uint32_t size[] = {width, height};
        xcb_configure_window(connection_, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
        sync();
    }
    /// As long as a hand takes: the viewer looks at keys and buttons once a frame.
    void pause() const {
        const timespec time{0, 150'000'000};
        nanosleep(&time, nullptr);
    }

private:
    void fake(std::uint8_t type, std::uint8_t detail) const {
        xcb_test_fake_input(connection_, type, detail, XCB_CURRENT_TIME, XCB_NONE, 0, 0, 0);
        sync();
    }
    void sync() const { owned(xcb_get_input_focus_reply(connection_, xcb_get_input_focus(connection_), nullptr)); }
    std::optional<xcb_window_t> find_below(xcb_window_t parent, const std::string& title) const {
        const auto name = owned(xcb_get_property_reply(
            connection_, xcb_get_property(connection_, 0, parent, XCB_ATOM_WM_NAME, XCB_ATOM_ANY, 0, 256), nullptr));
        const std::string text(static_cast<const char*>(xcb_get_property_value(name.get())),
                               std::size_t(xcb_get_property_value_length(name.get())));
        if (text.find(title) != std::string::npos) return parent;
        const auto tree = owned(xcb_query_tree_reply(connection_, xcb_query_tree(connection_, parent), nullptr));
        const xcb_window_t* children = xcb_query_tree_children(tree.get());
        for (int i = 0; i < xcb_query_tree_children_length(tree.get()); ++i)
            if (const auto found = find_below(children[i], title)) return found;
        return std::nullopt;
    }

    xcb_connection_t* connection_;
    xcb_screen_t* screen_ = nullptr;
};

void drag(const Display& display, xcb_window_t window, const std::vector<int>& way) {
    constexpr int kSteps = 10;
    display.move_pointer(window, way.at(0), way.at(1));
    display.pause();
    display.button(true);
    display.pause();
    for (int i = 1; i <= kSteps; ++i) {
        display.move_pointer(window, way[0] + (way.at(2) - way[0]) * i / kSteps,
                             way[1] + (way.at(3) - way[1]) * i / kSteps);
        display.pause();
    }
    display.button(false);
    display.pause();
}

void run(const std::vector<std::string>& words) {
    const Display display;
    const xcb_window_t window = display.find(words.at(1));
    const std::string& command = words.at(0);
    if (command == "capture") {
        pellucid::write_image(words.at(2), display.capture(window));
        return;
    }
    std::vector<int> numbers;
    for (std::size_t i = 2; i < words.size(); ++i) numbers.push_back(std::stoi(words[i]));
    if (command == "keys")
        display.keys(window, numbers);
    else if (command == "drag")
        drag(display, window, numbers);
    else if (command == "size")
        display.resize(window, std::uint32_t(numbers.at(0)), std::uint32_t(numbers.at(1)));
    else
        throw std::runtime_error(fmt::format("unknown command '{}'", command));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        run({argv + 1, argv + argc});
        return 0;
    } catch (const std::exception& error) {
        std::fputs(fmt::format("x_client: {}\n", error.what()).c_str(), stderr);
        return 1;
    }
}
