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

/// Care taken in building the hierarchy over the triangles (Embree's build qualities).
enum class BuildQuality { kLow, kMedium, kHigh };

struct TracerOptions {
    BuildQuality quality = BuildQuality::kHigh;
    bool deforming = false;     ///< triangles will move: set_positions() may refit instead of building anew
    bool robust = true;         ///< watertight between triangles; without, trace_fast() is up to a tenth faster
    std::uint32_t threads = 0;  ///< 0, or more than there are: all cores
};

/// What the exact tracer is asked for.
struct ExactSettings {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    std::uint32_t max_events = 16;  ///< K: a path of more has Status::kEventLimit; 1..65535
    glm::dvec2 shift_px{0.0};       ///< moves every primary ray from the centre of its pixel, right and down
    /// exact(): the part of the picture that is traced, its first pixel and its size; no size: all of it.
    glm::uvec2 part_first{0}, part_size{0};
    std::uint32_t packet = 1;  ///< rays traced together: 1, 4, 8, 16; the result is the same
    /// Colour channel at whose indices of refraction dispersive glass (Material::dispersion) bends and reflects the
    /// path: 0 red (C line), 1 green (d line, Material::ior), 2 blue (F line). Without dispersion all are alike.
    std::uint32_t channel = 1;
};

/// What the path tracer is asked for.
struct PathTraceSettings {
    std::uint32_t width = 512;  ///< pixels
    std::uint32_t height = 512;
    std::uint32_t samples = 64;  ///< paths per pixel, over the pixel's area
    /// Paths of every pixel, rows from the top, in place of `samples`; empty: all alike.
    std::vector<std::uint32_t> samples_of_pixels = {};
    std::uint32_t first_sample = 0;  ///< pictures with the same seed and other samples are independent
    std::uint32_t seed = 1;
    std::uint32_t max_vertices = 256;  ///< a path that is longer is cut and counted
    /// Photons per sample, for light of scene lights that mirrors and refracts before it meets something else; 0: none.
    std::uint32_t photons = 0;
    bool parts = false;  ///< fill PathTracedImage::parts
};

/// Names of the parts of a picture: its light as AOVs of the technique path.
inline constexpr std::array<std::string_view, 4> kLightParts{"emitted", "direct", "caustic", "indirect"};

/// A path-traced picture. It depends on the scene, the settings and nothing else: not on threads.
struct PathTracedImage {
    Image radiance;        ///< RGB, scene-linear, mean over the samples
    Image standard_error;  ///< RGB, of that mean; 0 for one sample
    std::uint32_t samples = 0;
    std::uint64_t cut_paths = 0;  ///< paths that reached max_vertices, over all pixels
    /// RGB, in the order of kLightParts; they add up to `radiance`. In Heckbert's notation, D everything that is not smooth:
    /// E S* L, E S* D L, E S* D S+ L, and E S* D (S* D)+ S* L. Light straight through smooth panes has met nothing.
    std::array<Image, 4> parts;
    std::vector<std::string> warnings;  ///< what light is lost; one line each
};

/// Light that lights of the scene bring to an object, W, RGB, before any kernel.
struct LightFlux {
    glm::dvec3 direct{0.0};   ///< by shadow rays from its surface; 0 for glass
    glm::dvec3 photons{0.0};  ///< stored on it, after mirrors and refractions
};

/// Exact ray tracing on the CPU (Embree): the truth that techniques are held against. Shares no
/// optics code with the renderer.
///
/// A ray refracts at every interface by the interpolated normal; which side of a solid it is on
/// follows from the triangles it crossed. Where solids overlap, the one of the highest priority fills the
/// place, then the one of less volume: liquid displaces the goblet, a bubble the block around it. Around all
/// solids rays bend in the scene's volumes.
class PELLUCID_API Tracer {
public:
    /// Builds the hierarchy. `scene` must be checked (load_scene does it) and outlive the tracer.
    explicit Tracer(const Scene& scene, const TracerOptions& options = {});
    ~Tracer();
    Tracer(Tracer&&) noexcept;
    Tracer& operator=(Tracer&&) noexcept;

    /// Time that building the hierarchy took last, ms.
    double build_ms() const;
    /// Threads that it builds and traces with.
    std::uint32_t threads() const;

    /// One path per pixel, through its centre; rows from the top.
    std::vector<RefractedPath> exact(const Camera& camera, const ExactSettings& settings,
                                     const Progress& progress = {}) const;

    /// Where the light of the same paths comes from, in single precision, without the care that exact() takes at
    /// edges and where solids touch: the fastest way known, for timing. Writes one unit vector per pixel
    /// (world), rows from the top, into `directions`; throws Error if that has not as many. A path that is too
    /// long ends where it is, as in exact(). Packets of different sizes may differ in single pixels.
    void trace_fast(const Camera& camera, const ExactSettings& settings, std::span<glm::vec3> directions) const;

    /// Unidirectional path tracing with next-event estimation (Kajiya 1986; Veach 1997, chapters 9
    /// and 10). Paths only meet point, spot and directional lights by aiming at them, so without photons
    /// the light of these does not come through refracting glass or from mirrors. With them it does, by progressive
    /// photon mapping (Hachisuka & Jensen 2009; Knaus & Zwicker 2011). From the first boundary of dispersive glass on a path
    /// follows one colour channel.
    PathTracedImage path_trace(const Camera& camera, const Environment& environment, const PathTraceSettings& settings,
                               const Progress& progress = {}) const;

    /// Light on every object of the scene, by as many photons over all lights and by shadow rays from points of every opaque
    /// object. What lights send out is what arrives and what is absorbed on the way, by glass and metal, or flies off.
    std::vector<LightFlux> light_flux(std::uint32_t photons, std::uint32_t seed = 1) const;

    /// Moves vertices in every object that shows the meshes, and refits the hierarchy (needs
    /// TracerOptions::deforming) or builds it anew, once for all of them. The first refit after a build takes
    /// as long as a build of medium quality: Embree makes the hierarchy that it refits then. Throws Error,
    /// and moves nothing, if a mesh does not exist or the counts differ.
    enum class Update { kRefit, kRebuild };
    void set_positions(const std::vector<MovedMesh>& moved, Update update);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace pellucid
