// Rays through volumes on the device against their C++ twin and against rays that are known.
#include "optics/eikonal.h"
#include "optics/index_fields.h"
#include "optics/phase.h"
#include "volume/upload_volumes.h"

#include <pellucid/scene.h>

#include "gpu/device_test.h"
#include "gpu_tests/shaders.h"

#include <functional>
#include <random>

namespace pellucid::test {
namespace {

struct Case {
    glm::vec4 position, direction;
};
struct Answer {
    glm::vec4 field;
    glm::vec4 x[6], v[6];
};

Scene scene_of(const std::vector<std::string>& specs) {
    Scene scene;
    for (const std::string& spec : specs) {
        VolumeObject object;
        object.volume = int(scene.volumes.size());
        scene.volumes.push_back(std::make_shared<const Volume>(make_volume(spec)));
        scene.volume_objects.push_back(object);
    }
    return scene;
}

/// The field of a volume's voxels in double precision, as volume_field.glsl has it.
struct VoxelField {
    const Volume& volume;

    IndexSample<double> voxel(glm::ivec3 at) const {
        const auto n = [&](glm::ivec3 p) {
            p = glm::clamp(p, glm::ivec3(0), glm::ivec3(volume.size) - 1);
            return double(
                volume.n[std::size_t(p.x) + volume.size.x * (std::size_t(p.y) + volume.size.y * std::size_t(p.z))]);
        };
        IndexSample<double> sample{{}, n(at)};
        for (int k = 0; k < 3; ++k) {
            glm::ivec3 before = at, after = at;
            --before[k], ++after[k];
            const bool face = before[k] < 0 || after[k] == int(volume.size[k]);
            sample.gradient[k] = (n(after) - n(before)) * (face ? 1.0 : 0.5);
        }
        return sample;
    }
    IndexSample<double> operator()(glm::dvec3 x) const {
        const glm::dvec3 position = glm::clamp(x - 0.5, glm::dvec3(0.0), glm::dvec3(volume.size) - 1.0);
        const glm::dvec3 corner = glm::min(glm::floor(position), glm::dvec3(volume.size) - 2.0), w = position - corner;
        IndexSample<double> sum{{}, 0.0};
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 offset(k & 1, k >> 1 & 1, k >> 2);
            const glm::dvec3 share = glm::mix(1.0 - w, w, glm::dvec3(offset));
            const IndexSample<double> at = voxel(glm::ivec3(corner) + offset);
            const double weight = share.x * share.y * share.z;
            sum.gradient += weight * at.gradient;
            sum.n += weight * at.n;
        }
        for (int k = 0; k < 3; ++k)
            if (x[k] < 0.5 || x[k] > double(volume.size[k]) - 0.5) sum.gradient[k] = 0.0;
        return sum;
    }
};

/// The same by cubic B-splines, in the form of divided powers. The gradient is the value's, by differences.
double cubic_index(const VoxelField& field, const glm::dvec3& x) {
    const glm::dvec3 size(field.volume.size), at = glm::clamp(x - 0.5, glm::dvec3(0.0), size - 1.0);
    const auto spline = [](double t) {
        const auto cubed = [](double s) { return s > 0.0 ? s * s * s : 0.0; };
        return (cubed(t + 2) - 4 * cubed(t + 1) + 6 * cubed(t) - 4 * cubed(t - 1) + cubed(t - 2)) / 6.0;
    };
    // What would lie beyond a face goes on straight.
    const std::function<double(glm::ivec3)> value = [&](glm::ivec3 p) {
        for (int k = 0; k < 3; ++k) {
            const int last = int(field.volume.size[k]) - 1, inner = p[k] < 0 ? 0 : last;
            if (p[k] >= 0 && p[k] <= last) continue;
            glm::ivec3 face = p, before = p;
            face[k] = inner;
            before[k] = inner == 0 ? 1 : last - 1;
            return 2.0 * value(face) - value(before);
        }
        return field.voxel(p).n;
    };
    const glm::ivec3 low(glm::floor(at));
    double sum = 0.0;
    for (int z = -1; z < 3; ++z)
        for (int y = -1; y < 3; ++y)
            for (int i = -1; i < 3; ++i) {
                const glm::ivec3 p = low + glm::ivec3(i, y, z);
                const double weight = spline(at.x - p.x) * spline(at.y - p.y) * spline(at.z - p.z);
                if (weight > 0.0) sum += weight * value(p);
            }
    return sum;
}

class EikonalTwin : public DeviceTest {
protected:
    std::vector<Answer> run(const Scene& scene, const std::vector<Case>& cases, bool cubic = false) {
        const VolumeImages volumes = upload_volumes(device(), scene);
        const Buffer& input = workspace().buffer("cases", cases.size() * sizeof(Case), true);
        const Buffer& output = workspace().buffer("answers", cases.size() * sizeof(Answer), true);
        std::memcpy(input.mapped(), cases.data(), input.size());
        recorder().compute(workspace().compute(shaders::eikonal_twin_comp, {{"kCubic", cubic}}),
                           {reads("volume_index", volumes.index), reads("volume_bricks", volumes.bricks),
                            reads("Volumes", volumes.records), reads("Cases", input), writes("Answers", output)},
                           {std::uint32_t(cases.size()), 1});
        recorder().submit_and_wait();
        return read_back<Answer>(output);
    }
};

TEST_F(EikonalTwin, ShaderAgreesWithCpp) {
    // The second volume, of the smaller box, comes first in the records and lies elsewhere in the image.
    const Scene scene = scene_of({"smoothed-sphere,resolution=40,radius=2", "luneburg,resolution=32"});
    const Volume& volume = *scene.volumes[1];
    const VoxelField field{volume};
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    std::vector<Case> cases;
    for (int i = 0; i < 500; ++i) {
        const auto random = [&] { return glm::vec3(uniform(generator), uniform(generator), uniform(generator)); };
        cases.push_back({glm::vec4(16.0f + 17.0f * random(), 0.5f), glm::vec4(glm::normalize(random()), 24.0f)});
    }
    const std::vector<Answer> answers = run(scene, cases), cubic = run(scene, cases, true);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const glm::dvec3 x(cases[i].position), d(cases[i].direction);
        const IndexSample<double> sample = field(x);
        EXPECT_NEAR(double(answers[i].field.w), sample.n, 1e-5);
        EXPECT_LT(glm::distance(glm::dvec3(answers[i].field), sample.gradient), 1e-5);
        const bool within =
            glm::all(glm::greaterThan(x, glm::dvec3(0.6))) && glm::all(glm::lessThan(x, glm::dvec3(volume.size) - 0.6));
        EXPECT_NEAR(double(cubic[i].field.w), cubic_index(field, x), 1e-5);
        for (int k = 0; k < 3 && within; ++k) {
            glm::dvec3 step(0.0);
            step[k] = 1e-4;
            EXPECT_NEAR(double(cubic[i].field[k]), (cubic_index(field, x + step) - cubic_index(field, x - step)) / 2e-4,
                        1e-4);
        }
        const double h = double(cases[i].position.w);
        CurvedRay<double> rays[6];
        std::fill_n(rays, 6, start_ray<double>(field, x, d));
        for (int step = 0; step < 24; ++step) {
            rays[0] = euler_step(field, rays[0], h);
            rays[1] = rk4_step(field, rays[1], h);
            rays[2] = euler_step<RayStep::kTime>(field, rays[2], h);
            rays[3] = rk4_step<RayStep::kTime>(field, rays[3], h);
            rays[4] = leapfrog_step(field, rays[4], h);
            rays[5] = nystrom_step(field, rays[5], h);
        }
        for (int k = 0; k < 6; ++k) {
            EXPECT_LT(glm::distance(glm::dvec3(answers[i].x[k]), rays[k].x), 1e-3) << i << " " << k;
            EXPECT_LT(glm::distance(glm::dvec3(answers[i].v[k]), rays[k].v), 1e-3) << i << " " << k;
        }
        EXPECT_NEAR(double(answers[i].v[0].w) / henyey_greenstein(d.x, d.y), 1.0, 1e-3);
    }
}

/// Where the lines of two ends of a step cross a plane of constant x.
glm::dvec3 at_plane(const Answer& before, const Answer& after, int method, double plane) {
    const glm::dvec3 a(before.x[method]), b(after.x[method]);
    return glm::mix(a, b, (plane - a.x) / (b.x - a.x));
}

TEST_F(EikonalTwin, LensesOfVoxelsImageWithinTheBars) {
    struct Lens {
        const char* spec;
        double bar;  // voxels
        bool parallel;
    };
    for (const Lens lens : {Lens{"luneburg", 0.5, true}, Lens{"maxwell-fisheye", 1.0, false}}) {
        const Scene scene = scene_of({std::string(lens.spec) + ",resolution=128"});
        const Volume& volume = *scene.volumes[0];
        const double radius = 1.0 / double(volume.voxel), middle = 64.0;
        std::vector<Case> cases;
        for (int i = -17; i <= 17; ++i) {
            const double height = 0.05 * i, angle = 0.075 * i;
            const double x = lens.parallel ? std::sqrt(1.0 - height * height) : 1.0;
            const glm::vec3 direction =
                lens.parallel ? glm::vec3(1, 0, 0) : glm::vec3(std::cos(angle), std::sin(angle), 0.0f);
            for (float steps = 0.0f; steps < 700.0f; steps += 1.0f)
                cases.push_back(
                    {glm::vec4(float(middle - radius * x), float(middle + (lens.parallel ? radius * height : 0.0)),
                               float(middle), 0.5f),
                     glm::vec4(direction, steps)});
        }
        const std::vector<Answer> answers = run(scene, cases);
        double worst[2] = {0.0, 0.0};
        for (std::size_t ray = 0; ray < 35; ++ray)
            for (const int method : {0, 1})
                for (std::size_t step = 1; step < 700; ++step) {
                    const Answer &before = answers[700 * ray + step - 1], &after = answers[700 * ray + step];
                    if (double(after.x[method].x) < middle + radius) continue;
                    const glm::dvec3 end = at_plane(before, after, method, middle + radius);
                    worst[method] = std::max(worst[method], std::hypot(end.y - middle, end.z - middle));
                    break;
                }
        std::printf("%s, 128 voxels, step 0.5: farthest from the antipode: Euler %.3f, RK4 %.3f voxels\n", lens.spec,
                    worst[0], worst[1]);
        EXPECT_GT(worst[1], 0.0) << lens.spec;
        EXPECT_LT(worst[1], lens.bar) << lens.spec;
    }
}

TEST_F(EikonalTwin, LinearIndexBendsRaysIntoCatenaries) {
    const Scene scene = scene_of({"linear,resolution=128,n0=1.5,slope=0.4"});
    const double voxel = double(scene.volumes[0]->voxel);
    const std::vector<Answer> answers = run(scene, {{glm::vec4(4, 40, 64, 0.5f), glm::vec4(1, 0, 0, 200)}});
    // n = n1 cosh(slope x / n1) along a ray that starts level where the index is n1.
    const double n1 = 1.5 + 0.4 * (40.0 - 64.0) * voxel;
    const glm::dvec3 end(answers[0].x[1]);
    const double rise = n1 / 0.4 * (std::cosh(0.4 * (end.x - 4.0) * voxel / n1) - 1.0) / voxel;
    EXPECT_NEAR(end.y - 40.0, rise, 0.01);
    EXPECT_GT(rise, 10.0);  // it does bend
}

/// Voxels with a plane boundary of index 1.5 below and 1 above height `plane` (voxels), as a Gaussian smooths it.
Scene plane_of_voxels(float plane, float sigma) {
    auto volume = std::make_shared<Volume>();
    volume->name = "plane";
    volume->size = {4, 40, 4};
    for (std::uint32_t i = 0; i < volume->voxel_count(); ++i) {
        const double height = double(i / 4 % 40) + 0.5 - double(plane);
        volume->n.push_back(float(1.0 + 0.5 * smoothed_inside(height, double(sigma))));
    }
    Scene scene;
    scene.volumes.push_back(volume);
    scene.volume_objects.emplace_back();
    return scene;
}

TEST_F(EikonalTwin, PlaneOfVoxelsObeysSnellAndReflectsTotallyBeyondTheCriticalAngle) {
    constexpr double kBar = 0.2, kCriticalBar = 0.5;  // degrees
    const double critical = glm::degrees(std::asin(1.0 / 1.5));
    struct Crossing {
        double angle_deg;
        bool from_inside;
    };
    std::vector<Crossing> crossings;
    for (int degrees = 0; degrees <= 80; degrees += 5) crossings.push_back({double(degrees), false});
    for (int degrees = 0; degrees <= 40; degrees += 5) crossings.push_back({double(degrees), true});
    for (const double beyond : {kCriticalBar, 5.0, 20.0, 40.0}) crossings.push_back({critical + beyond, true});
    crossings.push_back({critical - kCriticalBar, true});
    double worst[2] = {0.0, 0.0};
    for (const float sigma : {0.5f, 0.75f, 1.0f}) {
        for (const float plane : {20.0f, 20.25f, 20.5f}) {
            std::vector<Case> cases;
            for (const Crossing& each : crossings) {
                const double a = glm::radians(each.angle_deg), up = each.from_inside ? 1.0 : -1.0;
                cases.push_back({glm::vec4(2.0f, plane - float(up) * 12.0f, 2.0f, 0.25f),
                                 glm::vec4(float(std::sin(a)), float(up * std::cos(a)), 0.0f, 2000.0f)});
            }
            const std::vector<Answer> answers = run(plane_of_voxels(plane, sigma), cases);
            for (std::size_t i = 0; i < cases.size(); ++i) {
                const auto [angle, from_inside] = crossings[i];
                SCOPED_TRACE(::testing::Message() << angle << " degrees, inside " << from_inside << ", sigma " << sigma
                                                  << ", plane " << plane);
                const glm::dvec3 in(cases[i].direction), normal(0.0, from_inside ? -1.0 : 1.0, 0.0);
                glm::dvec3 exact{};
                const bool through = refract_direction(in, normal, from_inside ? 1.5 : 1.0 / 1.5, exact);
                if (!through) exact = in - 2.0 * glm::dot(in, normal) * normal;
                for (const int method : {1, 3}) {  // Runge-Kutta, in space and in time
                    const glm::dvec3 out(answers[i].v[method]);
                    EXPECT_EQ(glm::dot(out, normal) < 0.0, through);
                    if (std::abs(angle - critical) < 1.0) continue;  // Snell's law is too steep there for a bar
                    const double error = angle_deg(out, exact);
                    EXPECT_LT(error, kBar);
                    worst[through ? 0 : 1] = std::max(worst[through ? 0 : 1], error);
                }
            }
        }
    }
    std::printf("plane of voxels, RK4, step 0.25: largest error: refracted %.3f, reflected %.3f degrees\n", worst[0],
                worst[1]);
}

}  // namespace
}  // namespace pellucid::test
