// visibility-layers on whole scenes: several solids, one in another, opaque things among them. Paths against the exact
// tracer, light against what is known of it and against the path tracer.
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"

#include <fmt/format.h>

namespace pellucid::test {
namespace {

constexpr std::uint32_t kSize = 96;

Mesh shape(const std::string& spec) { return load_scene("shape:" + spec).meshes.front(); }

glm::mat4 at(glm::vec3 position, glm::vec3 scale = glm::vec3(1.0f)) {
    return glm::scale(glm::translate(glm::mat4(1.0f), position), scale);
}

Material painted(glm::vec3 color) {
    Material material;
    material.base_color = glm::vec4(color, 1.0f);
    material.unlit = true;
    return material;
}

/// A wall of 2 x 2 m whose texture coordinates are 0..1, texels from the top left.
Mesh wall() {
    Mesh mesh = square();
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    return mesh;
}

/// Adds a wall of unlit texels, as they are.
void add_picture(Scene& scene, Image image, const glm::mat4& world_from_object, float alpha_cutoff = 0.0f) {
    Material material = painted(glm::vec3(1.0f));
    material.base_color_texture.image = int(scene.images.size());
    material.base_color_texture.nearest = true;
    material.alpha_cutoff = alpha_cutoff;
    material.double_sided = true;
    scene.images.push_back(std::move(image));
    scene.image_names.emplace_back("picture");
    add(scene, wall(), material, world_from_object);
}

/// Black and white are the same in sRGB and in linear light, and so is every mixture of channels.
Image fields(int columns, int rows) {
    Image image(columns, rows, 3);
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const int color = 1 + (x + 3 * y) % 7;
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = float(color >> c & 1);
        }
    }
    return image;
}

/// A chessboard of white fields and holes.
Image lattice(int count) {
    Image image(count, count, 4);
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) std::fill_n(image.at(x, y), 4, float((x + y) % 2));
    return image;
}

Scene two_balls() {
    Scene scene;
    add(scene, shape("sphere,segments=64"), glass());
    add(scene, shape("sphere,segments=64"), glass(), at({0.7f, 0.35f, -2.6f}));
    return scene;
}

Scene linked_rings() {
    Scene scene;
    add(scene, shape("torus"), glass(), at({-0.45f, 0, 0}) * glm::rotate(glm::mat4(1.0f), 1.3f, glm::vec3(1, 0, 0)));
    add(scene, shape("torus"), glass(), at({0.45f, 0, 0}) * glm::rotate(glm::mat4(1.0f), 0.3f, glm::vec3(1, 0, 0.3f)));
    return scene;
}

/// Two bubbles of air that overlap, as objects of their own.
Scene bubbles() {
    Scene scene;
    add(scene, with_flat_normals(cube(2.0f)), glass());
    add(scene, shape("sphere,segments=48"), glass(1.0f), at({-0.2f, 0, 0}, glm::vec3(0.5f)));
    add(scene, shape("sphere,segments=48"), glass(1.0f), at({0.25f, 0.25f, 0.1f}, glm::vec3(0.3f)));
    return scene;
}

/// A hole in a ball, that is part of its mesh.
Scene cavity() {
    const Mesh outer = shape("sphere,segments=64"), inner = inside_out(shape("sphere,segments=48"));
    Mesh mesh = outer;
    for (const glm::uvec3 t : inner.triangles) mesh.triangles.push_back(t + unsigned(outer.positions.size()));
    for (const glm::vec3 p : inner.positions) mesh.positions.push_back(0.55f * p + glm::vec3(0.15f, 0.1f, 0));
    mesh.normals.insert(mesh.normals.end(), inner.normals.begin(), inner.normals.end());
    mesh.texcoords[0].clear();
    mesh.texcoords[1].clear();
    return scene_of(std::move(mesh));
}

/// Glass around a liquid around a bubble; a gem that reaches from the liquid into the glass.
Scene nested() {
    Scene scene;
    add(scene, shape("sphere,segments=64"), glass(1.5f));
    add(scene, shape("sphere,segments=64"), glass(1.33f), at({0, 0, 0}, glm::vec3(0.8f)));
    add(scene, shape("sphere,segments=48"), glass(1.0f), at({-0.3f, 0.2f, 0.1f}, glm::vec3(0.3f)));
    add(scene, shape("gem"), glass(1.8f), at({0.5f, -0.2f, 0}, glm::vec3(0.35f)));
    return scene;
}

/// A liquid whose surface is the very wall of the hollow that it fills.
Scene touching() {
    Scene scene = cavity();
    add(scene, shape("sphere,segments=48"), glass(1.33f), at({0.15f, 0.1f, 0}, glm::vec3(0.55f)));
    return scene;
}

/// Opaque things inside the glass, through its surface, before and behind it.
Scene with_opaque() {
    Scene scene;
    add(scene, shape("sphere,segments=64"), glass());
    add(scene, shape("sphere,segments=32"), painted({0.9f, 0.2f, 0.1f}), at({-0.3f, 0.1f, 0}, {0.4f, 0.15f, 0.2f}));
    add(scene, shape("cube"), painted({0.1f, 0.8f, 0.2f}), at({0.6f, 0.5f, 0.2f}, {0.1f, 0.4f, 0.1f}));
    add(scene, shape("sphere,segments=32"), painted({0.1f, 0.2f, 0.9f}), at({0.35f, -0.4f, 1.6f}, glm::vec3(0.2f)));
    add(scene, shape("cube"), painted({0.8f, 0.8f, 0.1f}), at({-0.7f, -0.3f, -2.0f}, glm::vec3(0.5f)));
    return scene;
}

/// `solids` before a wall of coloured fields and, between them, one with holes.
Scene before_walls(Scene solids) {
    add_picture(solids, lattice(10), at({0, 0, -2.0f}, glm::vec3(1.3f)), 0.5f);
    add_picture(solids, fields(12, 12), at({0, 0, -3.0f}, glm::vec3(2.0f)));
    return solids;
}

/// How alike two tracings of a scene are, and what of it they met.
struct Alike {
    double share = 0.0;   ///< of the pixels with glass, those whose paths end alike
    int glass = 0;        ///< pixels
    int ends_opaque = 0;  ///< pixels whose exact path ends on something opaque behind glass
};

template <class Base>
class WholeScenesOf : public Base {
protected:
    using Base::renderer;
    /// The glass fills the picture's height to 70%.
    void set(const Scene& scene, const Environment& environment) {
        Scene solids = scene;
        std::erase_if(solids.objects, [&](const Object& o) { return !scene.materials[o.material].refractive(); });
        camera_ = framing_camera(scene_bounds(solids), kSize, kSize, Camera{}.vertical_fov);
        renderer().set_scene(scene);
        renderer().set_environment(environment);
        renderer().set_camera(camera_);
    }
    std::vector<RefractedPath> trace() {
        ExactSettings settings;
        settings.width = settings.height = kSize;
        return renderer().tracer().exact(camera_, settings);
    }
    RenderResult draw(const char* technique, std::uint32_t samples = 1, ParameterMap parameters = {}) {
        RenderSettings settings;
        settings.width = settings.height = kSize;
        settings.technique = technique;
        settings.samples = samples;
        settings.parameters = std::move(parameters);
        settings.paths = samples == 1;
        return renderer().render(settings);
    }
    Alike compare(const Scene& scene, const char* technique) {
        set(scene, uniform_environment());
        const auto exact = trace(), found = draw(technique).paths;
        const PixelFootprint footprint{0.0f, 2.0f * std::tan(0.5f * camera_.vertical_fov) / float(kSize)};
        Alike alike;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            const float error = path_error_deg(exact[i], found[i], footprint);
            if (error < 0.0f) continue;
            ++alike.glass;
            alike.share += error <= 1.0f ? 1.0 : 0.0;
            alike.ends_opaque += exact[i].object >= 0 ? 1 : 0;
        }
        alike.share /= std::max(alike.glass, 1);
        return alike;
    }

    Camera camera_;
};
class WholeScenes : public WholeScenesOf<RendererTest> {};

/// What holds whoever finds the surfaces of paths.
class EveryFinder : public WholeScenesOf<TechniqueTest> {};
INSTANTIATE_TEST_SUITE_P(WholeScenes, EveryFinder,
                         testing::Values("visibility-layers", "visibility-cube", "ray-tracing", "ray-tracing-cpu"),
                         technique_test_name);

struct Case {
    const char* name;
    Scene scene;
    double least;  ///< share of paths that end alike
};

// What is missing is chaos: a path of many events in which the last digits of single precision grow to a degree. The
// exact tracer, whose rays are shifted by 0.0001 pixels, agrees with itself no better on such pixels.
TEST_P(EveryFinder, PathsThroughManySolidsEndAsTheyShould) {
    const Case cases[] = {{"two balls", two_balls(), 0.99}, {"linked rings", linked_rings(), 0.98},
                          {"bubbles", bubbles(), 0.99},     {"cavity", cavity(), 0.99},
                          {"nested", nested(), 0.99},       {"touching", touching(), 0.99}};
    for (const Case& test : cases) {
        const Alike alike = compare(test.scene, GetParam());
        EXPECT_GE(alike.share, test.least) << test.name;
        EXPECT_GT(alike.glass, 1000) << test.name;
        RecordProperty(test.name, fmt::format("{:.4f} of {}", alike.share, alike.glass));
    }
}

// What is missing before walls: the wall's part above the picture is seen by the exact tracer alone.
TEST_P(EveryFinder, PathsEndOnOpaqueThingsInsideBehindAndBefore) {
    const Case cases[] = {{"opaque", with_opaque(), 0.99},
                          {"balls before walls", before_walls(two_balls()), 0.98},
                          {"rings before walls", before_walls(linked_rings()), 0.97},
                          {"nested before walls", before_walls(nested()), 0.98}};
    for (const Case& test : cases) {
        const Alike alike = compare(test.scene, GetParam());
        EXPECT_GE(alike.share, test.least) << test.name;
        EXPECT_GT(alike.glass, 400) << test.name;
        EXPECT_GT(alike.ends_opaque, alike.glass / 10) << test.name;
        RecordProperty(test.name, fmt::format("{:.4f} of {}", alike.share, alike.glass));
    }
}

// The view's map ends where the picture does. A wall goes on above it: a path that might end there says that it has left
// the picture, none ends elsewhere without a word, and maps of the meshes hold all of the wall.
TEST_F(WholeScenes, PathsThatLeaveThePictureSaySo) {
    Scene scene = two_balls();
    add_picture(scene, fields(4, 4), at({0, 0, -4.0f}, glm::vec3(12.0f)));
    set(scene, uniform_environment());
    const auto exact = trace();
    const auto layers = draw("visibility-layers", 1, {{"finish", 0.0}}).paths, cube = draw("visibility-cube").paths;
    int left = 0, glass = 0, hidden = 0, lost = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        if (exact[i].events == 0) continue;
        ++glass;
        left += layers[i].status == Status::kLeftScreen ? 1 : 0;
        hidden += exact[i].object == 2 && layers[i].object < 0 && layers[i].status == Status::kOk ? 1 : 0;
        lost += exact[i].object == 2 && cube[i].object != 2 ? 1 : 0;
    }
    EXPECT_GT(left, glass / 100);
    EXPECT_LE(hidden, glass / 200);  // chaos, as above
    EXPECT_LE(lost, glass / 200);
}

// What the view's map loses, reflected ways included, maps of the meshes finish: the picture is theirs.
TEST_F(WholeScenes, PathsThatLeaveThePictureAreFinished) {
    Scene scene = two_balls();
    add_picture(scene, fields(4, 4), at({0, 0, -4.0f}, glm::vec3(12.0f)));
    set(scene, uniform_environment());
    const ParameterMap branches = {{"branches", 8.0}};
    ParameterMap unfinished = branches;
    unfinished["finish"] = 0.0;
    const RenderResult layers = draw("visibility-layers", 1, branches), cube = draw("visibility-cube", 1, branches);
    const RenderResult lost = draw("visibility-layers", 1, unfinished);
    EXPECT_EQ(layers.status[std::size_t(Status::kLeftScreen)], 0u);
    int differ = 0, lost_differ = 0;
    for (std::size_t i = 0; i < cube.radiance.pixels.size(); ++i) {
        const float value = cube.radiance.pixels[i];
        differ += std::abs(layers.radiance.pixels[i] - value) > 0.01f * (0.1f + value) ? 1 : 0;
        lost_differ += std::abs(lost.radiance.pixels[i] - value) > 0.01f * (0.1f + value) ? 1 : 0;
    }
    EXPECT_LE(differ, int(layers.covered) / 200);  // chaos, as above
    EXPECT_GT(lost_differ, 10 * differ);
}

// A path that comes to a lattice ends on it or, through a hole, on what is behind: never on a hole.
TEST_P(EveryFinder, HolesAreSeenThroughGlass) {
    const Scene scene = before_walls(two_balls());
    set(scene, uniform_environment());
    int on_lattice = 0, on_wall = 0;
    for (const RefractedPath& path : draw(GetParam()).paths) {
        if (path.events == 0) continue;
        on_wall += path.object == 3 ? 1 : 0;
        if (path.object != 2) continue;
        ++on_lattice;
        const glm::vec2 field = (glm::vec2(path.position) / 1.3f + 1.0f) * 5.0f;
        const glm::vec2 to_border = glm::abs(field - glm::round(field));
        if (std::min(to_border.x, to_border.y) < 1e-3f) continue;
        // Texels run down from the top left; of an even number of rows the count from below is as odd.
        EXPECT_EQ((int(field.x) + 9 - int(field.y)) % 2, 1) << field.x << ", " << field.y;
    }
    EXPECT_GT(on_lattice, 200);
    EXPECT_GT(on_wall, 200);
}

// In the dark, all light is that of the fields: what the exact path leaves of the very texel. One part in a thousand
// is more than single precision needs for a few interfaces.
TEST_P(EveryFinder, UnlitColorsAreExact) {
    constexpr int kFields = 12;
    Scene scene = two_balls();
    add_picture(scene, fields(kFields, kFields), at({0, 0, -4.0f}, glm::vec3(2.0f)));
    set(scene, uniform_environment(glm::vec3(0.0f)));
    const Image image = fields(kFields, kFields);
    const auto exact = trace();
    const RenderResult drawn = draw(GetParam());
    int through_glass = 0, wrong = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        const RefractedPath& path = exact[i];
        if (path.object != 2 || path.events == 0) continue;
        const glm::vec2 field = (glm::vec2(path.position) / 2.0f + 1.0f) * (0.5f * kFields);
        const glm::vec2 to_border = glm::abs(field - glm::round(field));
        if (std::min(to_border.x, to_border.y) < 0.02f) continue;
        ++through_glass;
        const glm::vec3 color = rgb(image, int(field.x), kFields - 1 - int(field.y));
        const glm::vec3 seen = rgb(drawn.radiance, int(i % kSize), int(i / kSize));
        wrong += glm::distance(seen, path.transmittance * color) < 1e-3f ? 0 : 1;
    }
    EXPECT_GT(through_glass, 500);
    EXPECT_LE(wrong, through_glass / 100);  // paths that do not end alike, as above
    for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const RefractedPath& path = drawn.paths[y * kSize + x];
            if (path.events != 0) continue;  // seen directly: a colour of the picture, or the dark
            const glm::vec3 seen = rgb(drawn.radiance, int(x), int(y));
            ASSERT_LT(glm::distance(seen, glm::round(seen)), 1e-6f) << x << ", " << y;
        }
    }
}

// Nothing absorbs, so glass is invisible where light is the same from everywhere: no branch is lost or counted twice,
// whatever is cut off. 1e-3: some hundred products and sums in single precision, and samples' weights.
TEST_P(EveryFinder, WhiteFurnace) {
    const Case cases[] = {{"two balls", two_balls(), 0}, {"linked rings", linked_rings(), 0},
                          {"bubbles", bubbles(), 0},     {"cavity", cavity(), 0},
                          {"nested", nested(), 0},       {"touching", touching(), 0}};
    const ParameterMap ways[] = {{}, {{"branches", 3}}, {{"threshold", 0.2}}, {{"events", 5}}, {{"one-branch", 1}}};
    for (const Case& test : cases) {
        set(test.scene, uniform_environment());
        for (std::size_t way = 0; way < std::size(ways); ++way) {
            const Image image = draw(GetParam(), 2, ways[way]).radiance;
            const auto [least, most] = std::minmax_element(image.pixels.begin(), image.pixels.end());
            EXPECT_NEAR(*least, 1.0f, 1e-3f) << test.name << ", parameters " << way;
            EXPECT_NEAR(*most, 1.0f, 1e-3f) << test.name << ", parameters " << way;
        }
    }
}

// How many surfaces a dispatch follows a path to is a matter of time: not a bit of the picture depends on it, unless
// branches are cut because there are no more dispatches.
TEST_F(WholeScenes, SurfacesPerPassChangeTheTimeOnly) {
    for (const Scene& scene : {nested(), with_opaque()}) {
        set(scene, Environment{});
        const auto picture = [&](double surfaces) {
            return draw("visibility-layers", 2, {{"surfaces-per-pass", surfaces}, {"branches", 0}}).radiance.pixels;
        };
        const std::vector<float> one_by_one = picture(1);
        for (const double surfaces : {3.0, 16.0}) EXPECT_TRUE(picture(surfaces) == one_by_one) << surfaces;
    }
}

/// Pictures of the same light, with noise: how far apart they are in the mean, in standard deviations of that, and per
/// pixel, as a share of the noise of both.
struct Estimates {
    double deviations = 0.0, noise = 0.0;
};
Estimates apart(const Image& drawn, const RenderResult& truth) {
    double difference = 0.0, variance = 0.0, noise = 0.0;
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) {
        const double d = double(drawn.pixels[i]) - double(truth.radiance.pixels[i]);
        difference += d;
        noise += d * d;
        variance += 2.0 * std::pow(double(truth.standard_error.pixels[i]), 2.0);  // of both, which are as noisy
    }
    // Channels go together: three times the variance.
    return {difference / std::sqrt(3.0 * variance), std::sqrt(noise / variance)};
}

// Both estimate the same light, from rays spread over the pixel: per pixel they differ by their noise, and in the mean
// by so much less. Choices that go together at two interfaces of a path show in the noise: it then falls more slowly
// than the samples grow (1.1 to 1.2 here, 1.9 to 2.0 with 1024).
TEST_F(WholeScenes, OneBranchPerSampleEstimatesAllLight) {
    Environment checker;
    checker.kind = Environment::Kind::kChecker;
    constexpr std::uint32_t kSamples = 256;
    const Case cases[] = {
        {"balls before walls", before_walls(two_balls()), 0}, {"opaque", with_opaque(), 0}, {"nested", nested(), 0}};
    for (const Case& test : cases) {
        set(test.scene, checker);
        const RenderResult truth = draw("path", kSamples);
        const Image drawn = draw("visibility-layers", kSamples, {{"one-branch", 1}}).radiance;
        const Estimates estimates = apart(drawn, truth);
        EXPECT_LT(std::abs(estimates.deviations), 4.0) << test.name;  // chance is out of the question beyond
        EXPECT_LT(estimates.noise, 1.05) << test.name;
        EXPECT_GT(estimates.noise, 0.5) << test.name;
        RecordProperty(test.name,
                       fmt::format("{:+.2f} deviations, noise {:.3f}", estimates.deviations, estimates.noise));
    }
}

// The same of rough glass: light between the facets, and from one to the next, is the path tracer's. Either way of
// following paths, as branches and as one.
TEST_F(WholeScenes, RoughGlassConvergesToThePathTracer) {
    Environment checker;
    checker.kind = Environment::Kind::kChecker;
    constexpr std::uint32_t kSamples = 256;
    for (const float roughness : {0.3f, 0.6f, 1.0f}) {
        Scene scene = two_balls();
        for (Material& material : scene.materials) material.roughness = roughness;
        scene.materials[1].attenuation_color = {0.5f, 0.8f, 0.9f};
        scene.materials[1].attenuation_distance = 2.0f;
        set(scene, checker);
        const RenderResult truth = draw("path", kSamples);
        for (const ParameterMap& way : {ParameterMap{{"one-branch", 1}}, ParameterMap{{"threshold", 0.0}}}) {
            const Estimates estimates = apart(draw("visibility-layers", kSamples, way).radiance, truth);
            const std::string name = fmt::format("roughness {}, {}", roughness, way.begin()->first);
            EXPECT_LT(std::abs(estimates.deviations), 4.0) << name;
            EXPECT_LT(estimates.noise, 1.1) << name;  // choices at one surface go together a little
            RecordProperty(name,
                           fmt::format("{:+.2f} deviations, noise {:.3f}", estimates.deviations, estimates.noise));
        }
    }
}

// Where light is the same from everywhere, rough glass shows it, too: no facet swallows light. 1e-3 as above.
TEST_F(WholeScenes, WhiteFurnaceOfRoughGlass) {
    for (const float roughness : {0.2f, 0.6f, 1.0f}) {
        for (const float ior : {1.2f, 2.42f}) {
            Scene scene = scene_of(shape("sphere,segments=64"), glass(ior));
            scene.materials[0].roughness = roughness;
            set(scene, uniform_environment());
            for (const double one_branch : {0.0, 1.0}) {
                const Image image = draw("visibility-layers", 4, {{"one-branch", one_branch}}).radiance;
                const auto [least, most] = std::minmax_element(image.pixels.begin(), image.pixels.end());
                EXPECT_NEAR(*least, 1.0f, 1e-3f) << roughness << ", " << ior << ", " << one_branch;
                EXPECT_NEAR(*most, 1.0f, 1e-3f) << roughness << ", " << ior << ", " << one_branch;
            }
        }
    }
}

}  // namespace
}  // namespace pellucid::test
