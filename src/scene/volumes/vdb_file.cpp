// Volumes in OpenVDB files (Museth, VDB: High-resolution sparse volumes with dynamic topology, 2013). This is the only
// file that includes OpenVDB's headers.
#include "core/byte_stream.h"
#include "core/fail.h"
#include "core/file.h"
#include "core/memory_budget.h"
#include "core/read_apart.h"
#include "optics/index_fields.h"
#include "scene/apart_readers.h"

#include <pellucid/error.h>
#include <pellucid/volume.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openvdb/io/File.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>

namespace pellucid {
namespace {

namespace vdb = openvdb;
namespace fs = std::filesystem;

// Metadata of our files with the size of the box, whose first voxel is (0, 0, 0). OpenVDB itself stores only voxels
// that differ from the background.
constexpr const char* kVoxels = "pellucid_voxels";
constexpr std::int64_t kMostVoxels = 65536;  // along an axis

/// Access to a scalar or colour field by its name.
struct FieldAccess {
    const char* name;
    std::vector<float> Volume::*number;
    std::vector<glm::vec3> Volume::*color;
    float background;
};
constexpr FieldAccess kFields[] = {
    {"n", &Volume::n, nullptr, 1.0f},
    {"n_red", &Volume::n_red, nullptr, 1.0f},
    {"n_blue", &Volume::n_blue, nullptr, 1.0f},
    {"sigma_a", nullptr, &Volume::sigma_a, 0.0f},
    {"sigma_s", nullptr, &Volume::sigma_s, 0.0f},
    {"g", &Volume::g, nullptr, 0.0f},
    {"emission", nullptr, &Volume::emission, 0.0f},
    {"boundary", &Volume::boundary, nullptr, 0.0f},
};

const FieldAccess* find_field(const std::string& name) {
    const auto found =
        std::find_if(std::begin(kFields), std::end(kFields), [&](const auto& f) { return f.name == name; });
    return found == std::end(kFields) ? nullptr : found;
}

std::string field_names() {
    std::vector<std::string> names;
    for (const FieldAccess& field : kFields) names.emplace_back(field.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

/// A grid's name for a message; the name may be empty.
std::string quoted(const std::string& name) { return fmt::format("'{}'", one_line(name)); }

/// Bytes of a value in dense storage.
std::size_t value_size(const vdb::GridBase& grid) {
    const bool twice = grid.isType<vdb::DoubleGrid>() || grid.isType<vdb::Vec3DGrid>();
    const bool vector = grid.isType<vdb::Vec3SGrid>() || grid.isType<vdb::Vec3DGrid>();
    return (twice ? 8 : 4) * (vector ? 3 : 1);
}

struct MappedGrid {
    vdb::GridBase::Ptr grid;
    GridMapping mapping;
};

template <class Grid>
std::vector<typename Grid::ValueType> dense_values(const Grid& grid, const vdb::CoordBBox& box) {
    std::vector<typename Grid::ValueType> values(box.volume());
    vdb::tools::Dense<typename Grid::ValueType, vdb::tools::LayoutXYZ> dense(box, values.data());
    vdb::tools::copyToDense(grid, dense);
    return values;
}

/// Visits a grid's values over a box: calls `number(i, value)` for scalars and `color(i, value)` for vectors.
template <class Number, class Color>
void visit_values(const fs::path& file, const vdb::GridBase& grid, const vdb::CoordBBox& box, const Number& number,
                  const Color& color) {
    const auto each = [](const auto& values, const auto& visit) {
        for (std::size_t i = 0; i < values.size(); ++i) visit(i, values[i]);
    };
    const auto vector = [&](std::size_t i, const auto& v) {
        color(i, glm::vec3(float(v[0]), float(v[1]), float(v[2])));
    };
    const auto scalar = [&](std::size_t i, auto v) { number(i, float(v)); };
    if (grid.isType<vdb::FloatGrid>())
        each(dense_values(static_cast<const vdb::FloatGrid&>(grid), box), scalar);
    else if (grid.isType<vdb::DoubleGrid>())
        each(dense_values(static_cast<const vdb::DoubleGrid&>(grid), box), scalar);
    else if (grid.isType<vdb::Vec3SGrid>())
        each(dense_values(static_cast<const vdb::Vec3SGrid&>(grid), box), vector);
    else if (grid.isType<vdb::Vec3DGrid>())
        each(dense_values(static_cast<const vdb::Vec3DGrid&>(grid), box), vector);
    else
        fail(file, fmt::format("grid {} has values of type {}; float, double, vec3s and vec3d are read",
                               quoted(grid.getName()), grid.valueType()));
}

bool is_distance(const std::string& field) { return field == "level-set" || field == "distance"; }

/// Adds the reflecting surface of a distance grid; a level set also adds a solid with the index of the mapping.
void add_distances(const fs::path& file, Volume& volume, const MappedGrid& mapped, const vdb::CoordBBox& box) {
    const bool is_solid = mapped.mapping.field == "level-set";
    const std::size_t count = volume.voxel_count();
    if (is_solid) volume.n.resize(count);
    volume.boundary.resize(count);
    const double sigma = 0.75 * double(volume.voxel);
    const auto number = [&](std::size_t i, float distance) {
        const double d = double(distance) * (is_solid ? 1.0 : double(mapped.mapping.scale)) / sigma;
        if (std::isnan(distance))
            fail(file, fmt::format("grid {} has values that are not finite", quoted(mapped.mapping.grid)));
        if (is_solid) volume.n[i] = float(1.0 + (double(mapped.mapping.scale) - 1.0) * smoothed_inside(d, 1.0));
        volume.boundary[i] = float(std::exp(-0.5 * d * d));
    };
    const auto color = [&](std::size_t, glm::vec3) {
        fail(file, fmt::format("grid {} has vectors, no distances", quoted(mapped.mapping.grid)));
    };
    visit_values(file, *mapped.grid, box, number, color);
}

void add_field(const fs::path& file, Volume& volume, const MappedGrid& mapped, const vdb::CoordBBox& box) {
    if (is_distance(mapped.mapping.field)) return add_distances(file, volume, mapped, box);
    const FieldAccess& field = *find_field(mapped.mapping.field);
    const std::size_t count = volume.voxel_count();
    const float scale = mapped.mapping.scale;
    if (field.number) (volume.*field.number).resize(count);
    if (field.color) (volume.*field.color).resize(count);
    const auto number = [&](std::size_t i, float v) {
        if (field.number)
            (volume.*field.number)[i] = scale * v;
        else
            (volume.*field.color)[i] = glm::vec3(scale * v);
    };
    const auto color = [&](std::size_t i, glm::vec3 v) {
        if (field.number)
            fail(file, fmt::format("grid {} has vectors, {} wants numbers", quoted(mapped.mapping.grid), field.name));
        (volume.*field.color)[i] = scale * v;
    };
    visit_values(file, *mapped.grid, box, number, color);
}

/// Grids named by the mapping, or else grids with the names of fields.
std::vector<MappedGrid> choose_grids(const fs::path& file, const vdb::GridPtrVec& grids,
                                     std::span<const GridMapping> mapping) {
    std::vector<std::string> present;
    for (const auto& grid : grids) present.push_back(quoted(grid->getName()));
    std::vector<MappedGrid> chosen;
    for (const GridMapping& each : mapping) {
        if (!is_distance(each.field) && !find_field(each.field))
            throw Error(fmt::format("grid {}: unknown field '{}'; known are {}, distance, level-set", quoted(each.grid),
                                    one_line(each.field), field_names()));
        const auto found =
            std::find_if(grids.begin(), grids.end(), [&](const auto& grid) { return grid->getName() == each.grid; });
        if (found == grids.end())
            fail(file, fmt::format("there is no grid {}; it has {}", quoted(each.grid), fmt::join(present, ", ")));
        chosen.push_back({*found, each});
    }
    if (!mapping.empty()) return chosen;
    for (const auto& grid : grids)
        if (find_field(grid->getName()) || grid->getName() == "distance")
            chosen.push_back({grid, {grid->getName(), grid->getName(), 1.0f}});
    if (chosen.empty())
        fail(file, present.empty()
                       ? "has no grids"
                       : fmt::format("has none of the grids {}; say which fields its grids are ({}), on the "
                                     "command line by --map GRID=FIELD[:SCALE]",
                                     field_names(), fmt::join(present, ", ")));
    return chosen;
}

/// The voxels of a grid. Our files store their box. For other files it is the box of active voxels plus one voxel
/// around it. Densities then fall to the background at the faces.
vdb::CoordBBox box_of(const vdb::GridBase& grid) {
    const auto size = grid.getMetadata<vdb::Vec3IMetadata>(kVoxels);
    if (size) return {vdb::Coord(0), vdb::Coord(size->value()).offsetBy(-1)};
    vdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    if (!box.empty()) box.expand(1);
    return box;
}

/// Size of a box in voxels. Throws Error for sizes that only a damaged file contains.
glm::uvec3 size_of(const fs::path& file, const vdb::CoordBBox& box) {
    glm::uvec3 size;
    for (int k = 0; k < 3; ++k) {
        const std::int64_t extent = std::int64_t(box.max()[k]) - box.min()[k] + 1;
        if (extent < 2 || extent > kMostVoxels)
            fail(file, fmt::format("its grids are {} voxels along {}; 2 to {} are read",
                                   std::max<std::int64_t>(extent, 0), "xyz"[k], kMostVoxels));
        size[k] = unsigned(extent);
    }
    return size;
}

/// Throws Error unless voxels are cubes along the axes.
void check_transform(const fs::path& file, const vdb::math::Transform& transform) {
    const double edge = transform.voxelSize()[0];
    bool cubes = transform.isLinear() && edge > 0.0 && std::isfinite(edge);
    for (int k = 0; cubes && k < 3; ++k) {
        vdb::Vec3d unit(0.0), expected(0.0);
        unit[k] = 1.0;
        expected[k] = edge;
        const vdb::Vec3d along = transform.indexToWorld(unit) - transform.indexToWorld(vdb::Vec3d(0.0));
        cubes = (along - expected).length() <= 1e-5 * edge;
    }
    if (!cubes) fail(file, "its voxels are not cubes along the axes");
}

vdb::GridPtrVecPtr read_grids(const fs::path& file) {
    vdb::initialize();
    std::ifstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::badbit | std::ios::failbit);  // the library would read truncated data as zeros
    return vdb::io::Stream(stream, false).getGrids();
}

Volume read_volume(const fs::path& file, std::span<const GridMapping> mapping) {
    const vdb::GridPtrVecPtr grids = read_grids(file);
    const std::vector<MappedGrid> chosen = choose_grids(file, *grids, mapping);
    const vdb::math::Transform& transform = chosen.front().grid->transform();
    check_transform(file, transform);
    vdb::CoordBBox box;
    std::size_t bytes = 0, largest = 0;
    for (const MappedGrid& mapped : chosen) {
        if (mapped.grid->transform() != transform) fail(file, "its grids have different transforms");
        box.expand(box_of(*mapped.grid));
        const FieldAccess* field = find_field(mapped.mapping.field);
        bytes += field && field->color ? sizeof(glm::vec3) : field ? sizeof(float) : 2 * sizeof(float);
        largest = std::max(largest, value_size(*mapped.grid));
    }
    if (box.empty()) fail(file, "its grids are empty");

    Volume volume;
    volume.name = file.stem().string();
    volume.size = size_of(file, box);
    volume.voxel = float(transform.voxelSize()[0]);
    const vdb::Vec3d low = transform.indexToWorld(box.min().asVec3d() - vdb::Vec3d(0.5));
    volume.low = {float(low[0]), float(low[1]), float(low[2])};
    check_volume_fits(file.string(), volume.size, bytes + largest);
    for (const MappedGrid& mapped : chosen) add_field(file, volume, mapped, box);
    return volume;
}

/// As read_volume(), and for another process. Throws Error for all that is wrong with the file.
Volume volume_of(const fs::path& file, std::span<const GridMapping> mapping) {
    try {
        return read_volume(file, mapping);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::ios_base::failure&) {
        fail(file, "is no OpenVDB file, or ends too soon");
    } catch (const std::exception& error) {
        fail(file, fmt::format("is no OpenVDB file that can be read ({})", one_line(error.what())));
    }
}

template <class Grid, class Value>
void add_grid(vdb::GridPtrVec& grids, const Volume& volume, const char* name, float background, const Value& value) {
    using T = typename Grid::ValueType;
    const glm::ivec3 size(volume.size);
    std::vector<T> values(volume.voxel_count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(i);
    const vdb::CoordBBox box(vdb::Coord(0), vdb::Coord(size.x - 1, size.y - 1, size.z - 1));
    const vdb::tools::Dense<T, vdb::tools::LayoutXYZ> dense(box, values.data());
    const auto grid = Grid::create(T(typename vdb::VecTraits<T>::ElementType(background)));
    vdb::tools::copyFromDense(dense, *grid, T(typename vdb::VecTraits<T>::ElementType(0)));
    grid->setName(name);
    const auto transform = vdb::math::Transform::createLinearTransform(double(volume.voxel));
    const glm::dvec3 first = glm::dvec3(volume.low) + 0.5 * double(volume.voxel);
    transform->postTranslate(vdb::Vec3d(first.x, first.y, first.z));
    grid->setTransform(transform);
    grid->insertMeta(kVoxels, vdb::Vec3IMetadata(vdb::Vec3i(size.x, size.y, size.z)));
    grids.push_back(grid);
}

vdb::GridPtrVec grids_of(const Volume& volume, bool double_precision) {
    vdb::GridPtrVec grids;
    for (const FieldAccess& field : kFields) {
        if (field.number && !(volume.*field.number).empty()) {
            const auto value = [&](std::size_t i) { return (volume.*field.number)[i]; };
            if (double_precision)
                add_grid<vdb::DoubleGrid>(grids, volume, field.name, field.background, value);
            else
                add_grid<vdb::FloatGrid>(grids, volume, field.name, field.background, value);
        }
        if (field.color && !(volume.*field.color).empty()) {
            const auto value = [&](std::size_t i) {
                const glm::vec3 v = (volume.*field.color)[i];
                return vdb::Vec3d(double(v.r), double(v.g), double(v.b));
            };
            if (double_precision)
                add_grid<vdb::Vec3DGrid>(grids, volume, field.name, field.background, value);
            else
                add_grid<vdb::Vec3SGrid>(grids, volume, field.name, field.background,
                                         [&](std::size_t i) { return vdb::Vec3s(value(i)); });
        }
    }
    return grids;
}

}  // namespace

std::vector<std::byte> read_vdb_here(std::span<const std::byte> request) {
    ByteReader reader(request);
    const fs::path file = reader.text();
    std::vector<GridMapping> mapping(reader.value<std::uint64_t>());
    for (GridMapping& each : mapping) {
        each.grid = reader.text();
        each.field = reader.text();
        each.scale = reader.value<float>();
    }
    const Volume volume = volume_of(file, mapping);
    ByteWriter result;
    result.value(volume.size);
    result.value(volume.voxel);
    result.value(volume.low);
    for (const FieldAccess& field : kFields) {
        if (field.number) result.values(volume.*field.number);
        if (field.color) result.values(volume.*field.color);
    }
    return result.take();
}

Volume load_volume(const fs::path& file, std::span<const GridMapping> mapping) {
    check_readable(file);
    ByteWriter request;
    request.text(file.string());
    request.value(std::uint64_t(mapping.size()));
    for (const GridMapping& each : mapping) {
        request.text(each.grid);
        request.text(each.field);
        request.value(each.scale);
    }
    const std::vector<std::byte> result =
        read_apart(ApartKind::kVdb, read_vdb_here, request.take(), scene_memory(), file);
    Volume volume;
    volume.name = file.stem().string();
    ByteReader reader(result);
    volume.size = reader.value<glm::uvec3>();
    volume.voxel = reader.value<float>();
    volume.low = reader.value<glm::vec3>();
    for (const FieldAccess& field : kFields) {
        if (field.number) volume.*field.number = reader.values<float>();
        if (field.color) volume.*field.color = reader.values<glm::vec3>();
    }
    try {
        check_volume(volume);
    } catch (const Error& error) {
        fail(file, error.what());
    }
    return volume;
}

void save_volume(const fs::path& file, const Volume& volume, const VolumeFileOptions& options) {
    check_volume(volume);
    vdb::initialize();
    const vdb::GridPtrVec grids = grids_of(volume, options.double_precision);
    if (grids.empty()) throw Error(fmt::format("volume '{}' has no fields that could be saved", one_line(volume.name)));
    write_file_atomically(file, [&](const fs::path& temporary) {
        vdb::io::File archive(temporary.string());
        archive.setCompression(options.compress ? vdb::io::COMPRESS_BLOSC | vdb::io::COMPRESS_ACTIVE_MASK
                                                : vdb::io::COMPRESS_NONE);
        try {
            archive.write(grids);
        } catch (const std::exception& error) {
            fail(file, fmt::format("cannot be written ({})", one_line(error.what())));
        }
    });
}

}  // namespace pellucid
