// Median wall time of frames of 512x512 in C++, ms, for measure_frame_cost.py: frame_cost SCENE TECHNIQUE FRAMES

#include <pellucid/pellucid.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    pellucid::Renderer renderer;
    renderer.set_scene(pellucid::load_scene(argv[1]));
    renderer.set_environment(pellucid::load_environment("studio"));
    pellucid::RenderSettings settings;
    settings.technique = argv[2];
    std::vector<double> times_ms;
    for (int i = -2; i < std::atoi(argv[3]); ++i) {
        const auto start = std::chrono::steady_clock::now();
        const pellucid::RenderResult result = renderer.render(settings);
        const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
        if (i >= 0 && result.display.width == 512) times_ms.push_back(time.count());
    }
    std::printf("%.3f\n", pellucid::spread(times_ms).median);
}
