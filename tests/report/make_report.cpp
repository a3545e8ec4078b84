// Writes a small report for test_report.py into the folder that it is given: names that would break a careless page,
// a picture, a map and a time that are missing, and errors whose worst place is known.
#include "report/report.h"

#include <cstdio>

namespace {

using namespace pellucid;

constexpr int kWidth = 96;
constexpr int kHeight = 64;

const char* const kScenes[] = {"models/<img src=x onerror=alert(1)>.obj", "shape:\"knot\", 'tied' & \xff \xc3\xa9",
                               "/a/quite/long/path/to/a/folder/with/models/inside/a-scene-of-a-rather-long-name.glb"};
const char* const kTechniques[] = {"one-interface", "<b>fast</b> & \"loose\""};

Image gradient(float red) {
    Image image(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            image.at(x, y)[0] = red;
            image.at(x, y)[1] = float(x) / kWidth;
            image.at(x, y)[2] = float(y) / kHeight;
        }
    }
    return image;
}

/// Right at the left edge, more wrong to the right, nothing covered above, and a square of 32 pixels all wrong.
Image errors() {
    Image image(kWidth, kHeight, 1);
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) *image.at(x, y) = y < 8 ? -1.0f : float(x) * 0.1f;
    }
    for (int y = 20; y < 52; ++y) {
        for (int x = 8; x < 40; ++x) *image.at(x, y) = 180.0f;
    }
    return image;
}

void add(Report& report, int scene, int view, int technique) {
    const PictureOf of{kScenes[scene], view, kTechniques[technique]};
    const double rank = 0.1 * scene + 0.01 * view + 0.4 * technique;  // every run differs
    nlohmann::ordered_json run{{"scene", of.scene},
                               {"technique", of.technique},
                               {"view", view},
                               {"width", kWidth},
                               {"height", kHeight},
                               {"triangles", 12345},
                               {"within_1deg", 0.3 + rank},
                               {"within_5deg", 0.35 + rank},
                               {"median_deg", 20.0 * (1.0 - rank)},
                               {"status", {{"ok", 0.9}, {"missing_layer", 0.1}}}};
    if (scene > 0) run["frame_ms"] = 4.0 + 10.0 * rank;
    report.add_run(run);
    report.add_picture(of, PictureKind::kImage, gradient(0.2f + 0.6f * float(technique)));
    report.add_picture(of, PictureKind::kError, errors());
    if (technique == 0) report.add_picture(of, PictureKind::kFlip, Image(kWidth, kHeight, 1));  // no difference
}

}  // namespace

int main(int count, char** arguments) try {
    if (count != 2) return 2;
    Report report(arguments[1]);
    for (int scene = 0; scene < 3; ++scene) {
        for (int view = 0; view < 2; ++view) {
            report.add_picture({kScenes[scene], view, ""}, PictureKind::kImage, gradient(0.5f));
            for (int technique = 0; technique < 2; ++technique) add(report, scene, view, technique);
        }
    }
    report.finish({"a <i>device</i>", "a driver", "1.2.3", "pellucid compare 'a & b'", "exact rays"});
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
