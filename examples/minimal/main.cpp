// Renders a glass goblet into goblet.png, like `pellucid render shape:goblet -o goblet.png`.
#include <pellucid/pellucid.h>

#include <cstdio>
#include <exception>

int main() {
    try {
        pellucid::Renderer renderer;
        renderer.set_scene(pellucid::load_scene("shape:goblet"));
        renderer.set_environment(pellucid::load_environment("studio"));
        pellucid::RenderSettings settings;
        settings.width = 512;
        settings.height = 512;
        pellucid::write_image("goblet.png", renderer.render(settings).display);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "minimal: %s\n", error.what());
        return 1;
    }
}
