#pragma once

#include <pellucid/api.h>
#include <pellucid/environment.h>
#include <pellucid/image.h>
#include <pellucid/progress.h>
#include <pellucid/refracted_path.h>
#include <pellucid/scene.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid {

/// Quality of the hierarchy over the triangles (Embree's build qualities).
enum class BuildQuality { kLow, kMedium, kHigh };

struct TracerOptions {
    BuildQuality quality = BuildQuality::kHigh;
    bool deforming = false;     ///< triangles will move: set_positions() may refit instead of rebuilding
    bool robust = true;         ///< watertight between triangles; if false, trace_fast() is up to a tenth faster
    std::uint32_t threads = 0;  ///< 0, or more than the machine has: all cores
};

/// Settings of the exact tracer.
struct ExactSettings {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    std::uint32_t max_events = 16;  ///< K: longer paths end with Status::kEventLimit; 1..65535
    glm::dvec2 shift_px{0.0};       ///< offset of every primary ray from its pixel's centre, right and down
    /// exact(): traced rectangle of the image, as first pixel and size; size 0: the whole image.
    glm::uvec2 part_first{0}, part_size{0};
    std::uint32_t packet = 1;  ///< rays traced together: 1, 4, 8, 16; does not change the result
    /// Colour channel whose index of refraction applies in dispersive glass (Material::dispersion): 0 red (C line), 1
    /// green (d line, Material::ior), 2 blue (F line). Without dispersion all channels have the same index.
    std::uint32_t channel = 1;
};

/// Settings of the path tracer.
struct PathTraceSettings {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    std::uint32_t samples = 64;  ///< paths per pixel, over the pixel's area
    /// Paths of every pixel, rows from the top, instead of `samples`; empty: `samples` for each pixel.
    std::vector<std::uint32_t> samples_of_pixels = {};
    std::uint32_t first_sample = 0;  ///< images with equal seeds and disjoint ranges of samples are independent
    std::uint32_t seed = 1;
    std::uint32_t max_vertices = 256;  ///< longer paths are cut and counted
    /// Photons per sample. They carry light from scene lights over mirrors and refractions to the first other surface;
    /// 0: none.
    std::uint32_t photons = 0;
    bool parts = false;  ///< fill PathTracedImage::parts
};

/// Names of the parts of an image's light, which are AOVs of the technique `path`.
inline constexpr std::array<std::string_view, 4> kLightParts{"emitted", "direct", "caustic", "indirect"};

/// A path-traced image. It depends on the scene and the settings only, not on the number of threads.
struct PathTracedImage {
    Image radiance;        ///< RGB, scene-linear, mean over the samples
    Image standard_error;  ///< RGB, standard error of that mean; 0 for one sample
    std::uint32_t samples = 0;
    std::uint64_t cut_paths = 0;  ///< paths that reached max_vertices, over all pixels
    /// RGB, in the order of kLightParts; their sum is `radiance`. In Heckbert's notation, with D for everything that
    /// is not smooth: E S* L, E S* D L, E S* D S+ L, and E S* D (S* D)+ S* L. Smooth panes do not count as S for light
    /// that passes straight through.
    std::array<Image, 4> parts;
    std::vector<std::string> warnings;  ///< light that the image misses; one line each
};

/// Flux from the scene's lights to an object, W, RGB, before any kernel.
struct LightFlux {
    glm::dvec3 direct{0.0};   ///< estimated by shadow rays from its surface; 0 for glass
    glm::dvec3 photons{0.0};  ///< stored on the object, after mirrors and refractions
};

/// Exact ray tracing on the CPU (Embree): the reference for all techniques. It shares no optics code with the
/// renderer.
///
/// A ray refracts at every interface by the interpolated normal. The triangles that it crossed tell which side of a
/// solid it is on. Where solids overlap, the solid of highest priority fills the overlap, then the solid of smaller
/// volume: liquid displaces the goblet, a bubble displaces the block around it. Outside all solids, rays bend in the
/// scene's volumes.
class PELLUCID_API Tracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer.
    explicit Tracer(const Scene& scene, const TracerOptions& options = {});
    ~Tracer();
    Tracer(Tracer&&) noexcept;
    Tracer& operator=(Tracer&&) noexcept;

    /// Time of the last build of the hierarchy, ms.
    double build_ms() const;
    /// Number of threads for building and tracing.
    std::uint32_t threads() const;

    /// One path per pixel, through its centre; rows from the top.
    std::vector<RefractedPath> exact(const Camera& camera, const ExactSettings& settings,
                                     const Progress& progress = {}) const;

    /// Exit directions of the same paths, in single precision, without the special cases of exact() at edges and
    /// touching solids. This is the fastest known method, for timing. Writes one unit vector per pixel (world), rows
    /// from the top, into `directions`; throws Error if its size differs. A path that is too long ends at its last
    /// event, as in exact(). Packets of different sizes may differ in single pixels.
    void trace_fast(const Camera& camera, const ExactSettings& settings, std::span<glm::vec3> directions) const;

    /// Unidirectional path tracing with next-event estimation (Kajiya 1986; Veach 1997, chapters 9 and 10). Paths
    /// reach point, spot and directional lights only by next-event estimation. Without photons, light from them is
    /// therefore missing behind refracting glass and from mirrors. Photons add it by progressive photon mapping
    /// (Hachisuka & Jensen 2009; Knaus & Zwicker 2011). From its first dispersive interface on, a path follows one
    /// colour channel.
    PathTracedImage path_trace(const Camera& camera, const Environment& environment, const PathTraceSettings& settings,
                               const Progress& progress = {}) const;

    /// Flux on every object of the scene. `photons` photons over all lights estimate the refracted light; shadow rays
    /// from points on every opaque object estimate the direct light. Emitted flux that does not arrive was absorbed by
    /// glass or metal, or left the scene.
    std::vector<LightFlux> light_flux(std::uint32_t photons, std::uint32_t seed = 1) const;

    /// Moves vertices of meshes in every object that uses them. It then refits the hierarchy (needs
    /// TracerOptions::deforming) or rebuilds it, once for all meshes. The first refit after a build takes as long as a
    /// build of medium quality, because Embree then builds the hierarchy to refit. Throws Error and moves nothing if a
    /// mesh does not exist or the counts differ.
    enum class Update { kRefit, kRebuild };
    void set_positions(const std::vector<MovedMesh>& moved, Update update);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
