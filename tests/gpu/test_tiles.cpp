// Pictures that are drawn tile by tile are those that are drawn at once.
#include "gpu/gpu_test.h"
#include "unit/built_scenes.h"

#include "render/tiles.h"

#include <gmock/gmock.h>

#include <cstring>

namespace pellucid::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

RenderSettings settings_of(const char* technique) {
    RenderSettings settings;
    settings.width = 61;
    settings.height = 47;
    settings.technique = technique;
    settings.samples = 3;
    settings.paths = true;
    settings.aovs = aovs_of_paths();
    return settings;
}

RenderSettings in_tiles(RenderSettings settings) {
    settings.tile_pixels = 250;  // 16 tiles of 61 x 47
    return settings;
}

/// Rough glass, which scatters by random numbers.
Scene glass(float roughness = 0.3f) {
    Scene scene = load_scene("shape:torus");
    scene.materials.front().roughness = roughness;
    return scene;
}

/// The same before a wall, by which the picture is wider than the glass.
Scene glass_before_a_wall() {
    Scene scene = glass();
    const Bounds bounds = scene_bounds(scene);
    Material paint;
    paint.base_color = {0.8f, 0.3f, 0.1f, 1.0f};
    paint.double_sided = true;
    add(scene, square(), paint,
        glm::scale(glm::translate(glm::mat4(1.0f), bounds.center - glm::vec3(0.0f, 0.0f, 2.0f * bounds.radius)),
                   glm::vec3(0.7f * bounds.radius)));
    return scene;
}

bool same_paths(const std::vector<RefractedPath>& a, const std::vector<RefractedPath>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const RefractedPath& p, const RefractedPath& q) {
        return p.direction == q.direction && p.position == q.position && p.transmittance == q.transmittance &&
               p.length_inside == q.length_inside && p.events == q.events && p.reflections == q.reflections &&
               p.status == q.status && p.object == q.object && p.side_conflict == q.side_conflict;
    });
}

void expect_same_counts(const RenderResult& a, const RenderResult& b) {
    EXPECT_EQ(a.covered, b.covered);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.side_conflicts, b.side_conflicts);
    EXPECT_EQ(a.warnings, b.warnings);
    ASSERT_EQ(a.frames.size(), b.frames.size());
    for (std::size_t i = 0; i < a.frames.size(); ++i) EXPECT_EQ(a.frames[i].size(), b.frames[i].size());
}

void expect_same(const RenderResult& a, const RenderResult& b) {
    EXPECT_EQ(a.radiance.pixels, b.radiance.pixels);
    EXPECT_EQ(a.display.pixels, b.display.pixels);
    ASSERT_EQ(a.aovs.size(), b.aovs.size());
    for (const auto& [name, image] : a.aovs) EXPECT_EQ(image.pixels, b.aovs.at(name).pixels) << name;
    EXPECT_TRUE(same_paths(a.paths, b.paths));
    EXPECT_EQ(a.standard_error.pixels, b.standard_error.pixels);
    expect_same_counts(a, b);
}

/// Share of the pixels in which two pictures differ by more than `tolerance`.
double share_that_differs(const Image& a, const Image& b, float tolerance) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    std::size_t count = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const glm::vec3 difference = glm::abs(rgb(a, x, y) - rgb(b, x, y));
            count += glm::any(glm::greaterThan(difference, glm::vec3(tolerance))) ? 1 : 0;
        }
    }
    return double(count) / (double(a.width) * double(a.height));
}

class TiledBitForBit : public TechniqueTest {};

TEST_P(TiledBitForBit, IsThePictureDrawnAtOnce) {
    for (const float roughness : {0.0f, 0.3f}) {
        SCOPED_TRACE(roughness);
        renderer().set_scene(glass(roughness));
        const RenderSettings settings = settings_of(GetParam());
        const RenderResult whole = renderer().render(settings);
        EXPECT_GT(whole.covered, 300u);
        expect_same(whole, renderer().render(in_tiles(settings)));
    }
}

TEST_P(TiledBitForBit, TilesOfOnePixelAndOfThinRows) {
    renderer().set_scene(glass());
    RenderSettings settings = settings_of(GetParam());
    settings.samples = 1;
    for (const auto& [width, height] : {std::pair{7u, 5u}, {31u, 2u}}) {
        settings.width = width;
        settings.height = height;
        RenderSettings tiled = settings;
        tiled.tile_pixels = 1;
        renderer().render(settings);  // builds what is kept
        const RenderResult whole = renderer().render(settings);
        expect_same(whole, renderer().render(tiled));
    }
}

INSTANTIATE_TEST_SUITE_P(Tiles, TiledBitForBit,
                         ::testing::Values("ray-tracing", "ray-tracing-cpu", "visibility-cube", "ihrke-2007",
                                           "one-interface", "reference", "path"),
                         technique_test_name);

class Tiled : public RendererTest {};

// What the rasteriser interpolates is rounded by where in the image a pixel is, and vertices are snapped to parts of a
// pixel: opaque edges may cover a pixel more or less.
TEST_F(Tiled, OpaqueSurfacesAreTheSameButForRounding) {
    renderer().set_scene(glass_before_a_wall());
    for (const LayerBuilder builder :
         {LayerBuilder::kCompute, LayerBuilder::kSinglePass, LayerBuilder::kDepthPeeling}) {
        RenderSettings settings = settings_of("visibility-cube");
        settings.layer_builder = builder;
        const RenderResult whole = renderer().render(settings), tiled = renderer().render(in_tiles(settings));
        EXPECT_LT(share_that_differs(whole.radiance, tiled.radiance, 1e-4f), 0.005);
        EXPECT_LE(share_that_differs(whole.aovs.at("exit-object"), tiled.aovs.at("exit-object"), 0.0f), 0.005);
    }
}

// A map of a tile holds no glass beyond it: paths go to maps of meshes instead, which find the same surfaces up to
// rounding. Near edges of triangles a path may take another way.
TEST_F(Tiled, VisibilityLayersFindTheSameSurfaces) {
    renderer().set_scene(glass(0.0f));
    const RenderSettings settings = settings_of("visibility-layers");
    const RenderResult whole = renderer().render(settings), tiled = renderer().render(in_tiles(settings));
    EXPECT_EQ(whole.covered, tiled.covered);
    EXPECT_EQ(whole.status, tiled.status);
    EXPECT_LT(share_that_differs(whole.aovs.at("exit-direction"), tiled.aovs.at("exit-direction"), 1e-3f), 0.01);
    EXPECT_LT(share_that_differs(whole.radiance, tiled.radiance, 1e-2f), 0.02);
}

TEST_F(Tiled, SearchesOfTheViewEndAtTheTileAndSaySo) {
    renderer().set_scene(glass());
    const RenderSettings settings = settings_of("wang-2014");
    const RenderResult whole = renderer().render(settings), tiled = renderer().render(in_tiles(settings));
    EXPECT_THAT(whole.warnings, Not(Contains(HasSubstr("tiles"))));
    EXPECT_THAT(tiled.warnings, Contains(HasSubstr("drawn in tiles: wang-2014 finds no surface")));
    EXPECT_EQ(whole.covered, tiled.covered);
    EXPECT_EQ(whole.aovs.at("depth").pixels, tiled.aovs.at("depth").pixels);
    EXPECT_GT(tiled.status[std::size_t(Status::kLeftScreen)], whole.status[std::size_t(Status::kLeftScreen)]);
}

// As long as all glass fits in one.
TEST_F(Tiled, GlassIsKeptInOneTile) {
    renderer().set_scene(load_scene("shape:sphere"));
    RenderSettings settings = settings_of("wang-2014");
    settings.width = 160;
    RenderSettings tiled = settings;
    tiled.tile_pixels = 2500;
    for (const char* technique : {"wang-2014", "visibility-layers"}) {
        settings.technique = tiled.technique = technique;
        const RenderResult at_once = renderer().render(settings), in_parts = renderer().render(tiled);
        EXPECT_EQ(at_once.warnings, in_parts.warnings);
        EXPECT_EQ(at_once.covered, in_parts.covered);
        EXPECT_EQ(at_once.status, in_parts.status);
        EXPECT_EQ(share_that_differs(at_once.radiance, in_parts.radiance, 1e-4f), 0.0) << technique;
    }
}

TEST_F(Tiled, AnalysisIsTheSame) {
    renderer().set_scene(glass());
    RenderSettings settings = settings_of("visibility-cube");
    settings.view = View::kAnalysis;
    const RenderResult whole = renderer().render(settings);
    expect_same(whole, renderer().render(in_tiles(settings)));
}

// Sums of tiles are added in another order.
TEST_F(Tiled, EyesAdaptToTheWholePicture) {
    renderer().set_scene(glass());
    RenderSettings settings = settings_of("visibility-cube");
    settings.tonemap = ToneMap::kKrawczyk;
    const RenderResult whole = renderer().render(settings), tiled = renderer().render(in_tiles(settings));
    EXPECT_EQ(whole.radiance.pixels, tiled.radiance.pixels);
    EXPECT_NEAR(whole.adapted_cd_m2, tiled.adapted_cd_m2, 1e-5f * whole.adapted_cd_m2);
    EXPECT_EQ(share_that_differs(whole.display, tiled.display, 1.01f / 255.0f), 0.0);
}

TEST_F(Tiled, ProgressRisesToOneOnce) {
    renderer().set_scene(glass());
    for (const char* technique : {"visibility-cube", "reference"}) {
        RenderSettings settings = in_tiles(settings_of(technique));
        std::vector<double> shown;
        settings.progress = [&](double done) { shown.push_back(done); };
        renderer().render(settings);
        ASSERT_GE(shown.size(), 48u) << technique;  // 16 tiles of 3 samples
        EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end())) << technique;
        EXPECT_GT(shown.front(), 0.0);
        EXPECT_DOUBLE_EQ(shown.back(), 1.0);
    }
}

TEST_F(Tiled, PicturesMayBeLongerThanImagesOfTheDevice) {
    renderer().set_scene(glass());
    RenderSettings settings = settings_of("visibility-cube");
    settings.samples = 1;
    settings.width = 100000;
    settings.height = 2;
    const RenderResult result = renderer().render(settings);
    EXPECT_EQ(result.radiance.width, 100000);
    EXPECT_EQ(result.paths.size(), 200000u);
}

TEST(Tiles, HalvesHaveEveryPixelOnce) {
    std::vector<Tile> tiles{{{3, 5}, {701, 401}}};
    while (halve(tiles)) {
    }
    EXPECT_GT(tiles.size(), 2u);
    std::vector<int> drawn(704 * 406, 0);
    for (const Tile& tile : tiles) {
        EXPECT_LE(tile.pixels(), 65536u);
        for (std::uint32_t y = 0; y < tile.size.y; ++y)
            for (std::uint32_t x = 0; x < tile.size.x; ++x) ++drawn[(tile.first.y + y) * 704 + tile.first.x + x];
    }
    EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 1), 701 * 401);
    EXPECT_EQ(std::count(drawn.begin(), drawn.end(), 0), 704 * 406 - 701 * 401);
    EXPECT_EQ(tiles.back().first, glm::uvec2(3, 5));
}

}  // namespace
}  // namespace pellucid::test
