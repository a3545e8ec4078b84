// Uses the window of the viewer as a user's X server does: looks at its pixels, presses keys, moves the pointer.
//
//   x_client capture TITLE FILE.png     what the window shows
//   x_client keys TITLE KEYCODE...      presses all of the keys together
//   x_client drag TITLE X0 Y0 X1 Y1 [BUTTON]   with the left button (1), or 2 middle, 3 right
//   x_client wheel TITLE X Y STEPS      away from the user; negative: towards
//   x_client hold TITLE KEYCODE MS      keeps a key pressed
//   x_client drop TITLE FILE...         drops files by the protocol XDND, version 5
//   x_client size TITLE W H             resizes the window
#include <pellucid/image.h>

#include <fmt/format.h>
#include <xcb/xcb.h>
#include <xcb/xtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
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
    void button(bool down, int button) const {
        fake(down ? XCB_BUTTON_PRESS : XCB_BUTTON_RELEASE, std::uint8_t(button));
    }
    /// Presses the keys one after the other and releases them in the other order.
    void keys(xcb_window_t window, const std::vector<int>& codes) const {
        focus(window);
        for (auto code = codes.begin(); code != codes.end(); ++code) {
            fake(XCB_KEY_PRESS, std::uint8_t(*code));
            pause();
        }
        for (auto code = codes.rbegin(); code != codes.rend(); ++code) {
            fake(XCB_KEY_RELEASE, std::uint8_t(*code));
            pause();
        }
    }
    void hold(xcb_window_t window, int code, long time_ms) const {
        focus(window);
        fake(XCB_KEY_PRESS, std::uint8_t(code));
        pause(time_ms);
        fake(XCB_KEY_RELEASE, std::uint8_t(code));
        pause();
    }
    void drop(xcb_window_t window, const std::string& uris) const;
    void resize(xcb_window_t window, std::uint32_t width, std::uint32_t height) const {
        const std::uint32_t size[] = {width, height};
        xcb_configure_window(connection_, window, XCB_CONFIG_WINDOW_WIDTH | XCB_CONFIG_WINDOW_HEIGHT, size);
        sync();
    }
    /// As long as a hand takes: the viewer looks at keys and buttons once a frame.
    void pause(long time_ms = 150) const {
        const timespec time{time_ms / 1000, time_ms % 1000 * 1'000'000};
        nanosleep(&time, nullptr);
    }

private:
    void focus(xcb_window_t window) const {
        xcb_set_input_focus(connection_, XCB_INPUT_FOCUS_POINTER_ROOT, window, XCB_CURRENT_TIME);
    }
    xcb_atom_t atom(const char* name) const {
        return owned(xcb_intern_atom_reply(
                         connection_, xcb_intern_atom(connection_, 0, std::uint16_t(std::strlen(name)), name), nullptr))
            ->atom;
    }
    void tell(xcb_window_t window, const char* type, const std::array<std::uint32_t, 5>& data) const {
        xcb_client_message_event_t event{};
        event.response_type = XCB_CLIENT_MESSAGE;
        event.format = 32;
        event.window = window;
        event.type = atom(type);
        std::ranges::copy(data, event.data.data32);
        xcb_send_event(connection_, 0, window, XCB_EVENT_MASK_NO_EVENT, reinterpret_cast<const char*>(&event));
        xcb_flush(connection_);
    }
    /// Answers requests for what is dropped until a message of this type comes.
    std::array<std::uint32_t, 5> hear(const char* type, const std::string& uris) const;
    void hand_over(const xcb_selection_request_event_t& request, const std::string& uris) const;
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

void Display::hand_over(const xcb_selection_request_event_t& request, const std::string& uris) const {
    xcb_change_property(connection_, XCB_PROP_MODE_REPLACE, request.requestor, request.property, request.target, 8,
                        std::uint32_t(uris.size()), uris.data());
    xcb_selection_notify_event_t notify{};
    notify.response_type = XCB_SELECTION_NOTIFY;
    notify.time = request.time;
    notify.requestor = request.requestor;
    notify.selection = request.selection;
    notify.target = request.target;
    notify.property = request.property;
    xcb_send_event(connection_, 0, request.requestor, XCB_EVENT_MASK_NO_EVENT, reinterpret_cast<const char*>(&notify));
    xcb_flush(connection_);
}

std::array<std::uint32_t, 5> Display::hear(const char* type, const std::string& uris) const {
    const xcb_atom_t wanted = atom(type);
    for (;;) {
        const auto event = owned(xcb_wait_for_event(connection_));
        const int kind = event->response_type & 0x7f;
        if (kind == XCB_SELECTION_REQUEST)
            hand_over(reinterpret_cast<const xcb_selection_request_event_t&>(*event), uris);
        if (kind != XCB_CLIENT_MESSAGE) continue;
        const auto& message = reinterpret_cast<const xcb_client_message_event_t&>(*event);
        if (message.type != wanted) continue;
        std::array<std::uint32_t, 5> data{};
        std::ranges::copy(message.data.data32, data.begin());
        return data;
    }
}

void Display::drop(xcb_window_t window, const std::string& uris) const {
    const auto aware = owned(xcb_get_property_reply(
        connection_, xcb_get_property(connection_, 0, window, atom("XdndAware"), XCB_ATOM_ANY, 0, 1), nullptr));
    if (xcb_get_property_value_length(aware.get()) == 0) throw std::runtime_error("the window takes no files");
    const xcb_window_t source = xcb_generate_id(connection_);
    xcb_create_window(connection_, 0, source, screen_->root, 0, 0, 1, 1, 0, XCB_WINDOW_CLASS_INPUT_ONLY,
                      XCB_COPY_FROM_PARENT, 0, nullptr);
    xcb_set_selection_owner(connection_, source, atom("XdndSelection"), XCB_CURRENT_TIME);
    const std::uint32_t copy = atom("XdndActionCopy");
    tell(window, "XdndEnter", {source, 5u << 24, atom("text/uri-list"), 0, 0});
    tell(window, "XdndPosition", {source, 0, 0, XCB_CURRENT_TIME, copy});
    if ((hear("XdndStatus", uris)[1] & 1u) == 0) throw std::runtime_error("the window refuses the files");
    tell(window, "XdndDrop", {source, 0, XCB_CURRENT_TIME, 0, 0});
    hear("XdndFinished", uris);
}

/// The files as text/uri-list.
std::string uris_of(std::span<const std::string> files) {
    std::string uris;
    for (const std::string& file : files) {
        uris += "file://";
        for (const char c : std::filesystem::absolute(file).string())
            uris += c == ' ' || c == '%' ? fmt::format("%{:02X}", c) : std::string(1, c);
        uris += "\r\n";
    }
    return uris;
}

void drag(const Display& display, xcb_window_t window, const std::vector<int>& way) {
    const int button = way.size() > 4 ? way[4] : 1;
    constexpr int kSteps = 10;
    display.move_pointer(window, way.at(0), way.at(1));
    display.pause();
    display.button(true, button);
    display.pause();
    for (int i = 1; i <= kSteps; ++i) {
        display.move_pointer(window, way[0] + (way.at(2) - way[0]) * i / kSteps,
                             way[1] + (way.at(3) - way[1]) * i / kSteps);
        display.pause();
    }
    display.button(false, button);
    display.pause();
}

void wheel(const Display& display, xcb_window_t window, int x, int y, int steps) {
    const int button = steps > 0 ? 4 : 5;  // as the X server counts
    display.move_pointer(window, x, y);
    display.pause();
    for (int i = 0; i < std::abs(steps); ++i) {
        display.button(true, button);
        display.button(false, button);
        display.pause();
    }
}

void run(const std::vector<std::string>& words) {
    const Display display;
    const xcb_window_t window = display.find(words.at(1));
    const std::string& command = words.at(0);
    if (command == "capture") {
        pellucid::write_image(words.at(2), display.capture(window));
        return;
    }
    if (command == "drop") {
        display.drop(window, uris_of(std::span(words).subspan(2)));
        return;
    }
    std::vector<int> numbers;
    for (std::size_t i = 2; i < words.size(); ++i) numbers.push_back(std::stoi(words[i]));
    if (command == "keys")
        display.keys(window, numbers);
    else if (command == "drag")
        drag(display, window, numbers);
    else if (command == "wheel")
        wheel(display, window, numbers.at(0), numbers.at(1), numbers.at(2));
    else if (command == "hold")
        display.hold(window, numbers.at(0), numbers.at(1));
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
