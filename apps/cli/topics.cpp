#include "topics.h"

#include "lab/bench_suites.h"
#include "lab/experiments.h"
#include "options/help.h"
#include "options/translucency_options.h"

#include <pellucid/pellucid.h>

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace pellucid::cli {
namespace {

std::string row(std::string_view name, std::string_view text) { return help_row(name, text, 26); }

std::string scenes() {
    return "A scene is a .gltf, .glb, .obj, .ply, .stl, .off, .3ds or .vdb file, shape:NAME[,PARAMETER=VALUE...] "
           "(help shapes) or volume:NAME[,...] (help volumes). Files without materials are one solid of glass. Units "
           "are "
           "metres.\n"
           "\n"
           "--crease-angle DEG: normals that are computed are smooth across edges bent by less. Default: each shell's "
           "own angle, in a gap of its bends if there is one; 0 for .stl.\n"
           "--priority OBJECT=N: where solids overlap, the one of the highest whole number (default 0) displaces the "
           "others, then the one of less volume. 'pellucid info SCENE' lists the names.\n"
           "--animation NAME|N, --time S: the pose of a glTF file; default: the file at rest, or with --time its first "
           "animation.\n"
           "--allow-outside: images, buffers, volumes and material libraries outside the scene's folder are read, "
           "too.\n"
           "PELLUCID_MEMORY_SHARE, an environment variable: the share of the machine's memory that a scene may take "
           "while it is read (default 0.5).\n";
}

std::string list_of(const std::vector<ShapeInfo>& infos, std::string_view prefix) {
    std::string text;
    for (const ShapeInfo& info : infos) {
        text += fmt::format("{}:{}: {}\n", prefix, info.name, info.doc);
        for (const ShapeParameter& p : info.parameters)
            text += row(fmt::format("{}={}", p.name, p.default_value),
                        fmt::format("{} [{} to {}]", p.doc, p.minimum, p.maximum));
    }
    return text;
}

std::string shapes() { return list_of(shape_infos(), "shape"); }

std::string volumes() {
    return "--add-volume SOURCE[@X,Y,Z[,SCALE]] adds a .vdb file or volume:NAME, moved by X,Y,Z metres after it was "
           "scaled "
           "about its origin; a scale leaves what it absorbs and scatters in all.\n"
           "--map GRID=FIELD[:SCALE] names the field that a grid of a .vdb file is, and a factor on its values (1): n, "
           "n_red, n_blue, sigma_a, sigma_s, g, emission or boundary; distance, of which surfaces become that reflect; "
           "level-set, which also bounds a solid, whose index the factor is (1.5). Default: grids have the names of "
           "fields.\n"
           "\n" +
           list_of(volume_infos(), "volume");
}

std::string cameras() {
    return "--camera NAME: a camera of the file; 'pellucid info SCENE' lists them.\n"
           "--camera orbit:AZ,EL,DIST[,X,Y,Z]: azimuth and elevation in degrees and distance in radii of the scene's "
           "bounding sphere, from its centre or the point X,Y,Z. Azimuth 0 looks along -Z.\n"
           "Default: the file's first camera, or one that frames the scene from the front.\n"
           "--fov DEG: vertical field of view of an orbit camera, or of the one that frames the scene.\n";
}

std::string lights() {
    std::string text = "--add-light adds a light beside the file's:\n";
    for (const std::string& form : light_forms()) text += "  " + form + "\n";
    return text +
           "Azimuth and elevation in degrees say where the sun stands, as for --camera; positions are metres in the "
           "file's world. Last comes the size: a sun's diameter (0.53 degrees), a lamp's or spot's radius (0 m).\n"
           "\n"
           "--light says which light frames follow to opaque surfaces:\n" +
           row("environment", "of the environment alone, unshadowed") + row("direct", "of lights, too, with shadows") +
           row("full", "also reflected between surfaces, with what hides the environment") +
           row("automatic", "environment where there are no lights, full with 8 samples or more, direct with fewer") +
           "--shadows says what glass does to the straight ray to a light: exact blocks it, tinted weakens it.\n"
           "--caustics TECHNIQUE finds where the light of --photons leaves glass, run from the lights' views; default: "
           "photons follow every interface.\n"
           "--bounces N: reflections that rays follow, 0 to 7, before a cache has the rest (--light full).\n";
}

std::string environments() {
    return "--environment NAME|FILE is light from infinitely far away, and the background:\n" +
           row("studio", "a photographer's dark room with soft boxes") +
           row("checker", "squares of 15 degrees, coloured by direction") +
           row("sky", "a clear sky above a tiled plane, the sun behind on the right") +
           row("uniform", "the same from everywhere") + row("FILE", "an equirectangular map, .hdr or .exr") +
           "--environment-rotation DEG turns it about +Y: 90 brings light from +X to -Z.\n"
           "--environment-intensity X multiplies its radiance, in the background too.\n";
}

std::string aovs() {
    std::string text =
        "--aov NAME=FILE.exr writes a quantity per pixel, 32-bit float, at pixel centres; "
        "--multilayer NAME,NAME writes them as layers of -o FILE.exr:\n";
    for (const AovInfo& aov : aov_infos()) text += row(aov.name, aov.doc);
    return text;
}

std::string statuses() {
    return "The AOV status, and the shares in the JSON, say how the path of a pixel ended:\n" +
           row("0 ok", "it found every interface that it looked for") +
           row("1 missing_layer", "it met an interface in no layer that the technique looks at") +
           row("2 left_screen", "it left the image, where nothing is recorded, inside the glass") +
           row("3 step_limit", "it used up its search steps") +
           row("4 event_limit", "it had more events than the technique follows");
}

std::string presets_text() {
    std::string text =
        "--technique takes a technique (pellucid techniques) or a preset, which stands for the fastest "
        "technique of its kind on the device:\n";
    for (const PresetInfo& preset : presets()) text += row(preset.name, preset.summary);
    return text;
}

std::string sequences() {
    return "'pellucid sequence SCENE -o frame-####.png' renders one file per frame. Frame N shows the animation at "
           "--time + N / --fps seconds. Files that are there stay: the same command goes on where one was ended, and "
           "several at once share the frames.\n"
           "--camera-at FRAME=orbit:AZ,EL,DIST[,X,Y,Z] is the camera at a frame, --light-at FRAME=LIGHT a light, as of "
           "--add-light. Between two keys all numbers change smoothly, and never beyond the keys'; before the first "
           "and after the last they stay. Orbits keep to the bounds of the scene at rest.\n"
           "--frames A..B,C,... renders some of the frames. Frames that fail are left out, named at the end, and cause "
           "exit code 4.\n"
           "--slurm FILE writes a batch script for sbatch, --gather checks the frames that it made.\n";
}

std::string images() {
    return "--samples N averages N jittered frames in linear light; of the technique path, N paths per pixel.\n"
           "--error X gives each pixel the samples that its standard error needs to be at most X, as a share of its "
           "luminance and middle grey, up to --most-samples.\n"
           "--tonemap none clips to 0..1; reinhard, aces and neutral are curves; krawczyk adapts to the image as an "
           "eye "
           "does, where radiance 1 is --unit-luminance cd/m2.\n"
           "--view radiance is the image. analysis: red up to two interfaces, blue more, green total internal "
           "reflection, "
           "grey where the technique gave up. wavefront: light in volumes, by irradiance in W/m2 times the exposure, "
           "dark "
           "blue 1/16, white 1, red 16.\n";
}

std::string thickness() {
    std::string text =
        "Translucent solids are lit by what is left of light after the length of solid before a point. "
        "--thickness-method finds that length:\n";
    for (const ThicknessMethodInfo& info : thickness_methods()) text += row(info.name, info.summary);
    return text +
           "'pellucid thickness' writes it in metres: -1 where nothing translucent is seen or no light arrives, -2 in "
           "the shadow of something opaque. Its --thickness-method may also be exact: rays of Embree.\n";
}

std::string suites() {
    std::string text = "pellucid bench --suite NAME:\n";
    for (const auto& [name, doc] : suite_infos()) text += row(name, doc);
    return text;
}

std::string experiments_text() {
    std::string text = "pellucid experiment NAME:\n";
    for (const ExperimentSpec& spec : experiments())
        text += row(spec.name, fmt::format("{}; varied: {}", spec.source, spec.varied));
    return text;
}

constexpr std::array<Topic, 14> kTopics = {{
    {"scenes", "files, normals, overlapping solids, animation", scenes},
    {"shapes", "shape:NAME and its parameters", shapes},
    {"volumes", "volume:NAME, .vdb files and their grids", volumes},
    {"cameras", "--camera and --fov", cameras},
    {"lights", "--add-light, --light, --shadows", lights},
    {"environments", "--environment", environments},
    {"images", "--samples, --error, --tonemap, --view", images},
    {"sequences", "frames, --camera-at, --light-at, resuming", sequences},
    {"aovs", "--aov, --multilayer", aovs},
    {"statuses", "how the path of a pixel ends", statuses},
    {"presets", "names for a technique", presets_text},
    {"translucency", "light through translucent solids", thickness},
    {"suites", "of 'pellucid bench'", suites},
    {"experiments", "of 'pellucid experiment'", experiments_text},
}};

}  // namespace

std::span<const Topic> topics() { return kTopics; }

}  // namespace pellucid::cli
