// Coverage of voxels by solids from crossings along columns, after Eisemann & Decoret, "Single-pass GPU solid
// voxelization for real-time applications", 2008. They keep one bit per voxel; here coverage along the column is exact.
#include "volume/mesh_coverage.h"

#include "core/parallel.h"
#include "gpu/recorder.h"
#include "volume/shaders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace pellucid {
namespace {

constexpr std::int64_t kLattice = 256;                    // lattice units per column width; twin of kColumn
constexpr std::int32_t kFull = 65536;                     // units of a column through a whole voxel; twin of kFull
constexpr int kBlockSide = 16;                            // columns of a block along x and y
constexpr std::size_t kMostBlocks = 1u << 17;             // blocks per submission
constexpr vk::DeviceSize kMostBytes = 64u * 1024 * 1024;  // bytes of differences per slab

/// Twin of Block in cover_columns.comp.
struct Block {
    glm::ivec2 a, b, c, first_column, last_column;
    std::int32_t sign;
    std::int32_t unused = 0;
    glm::vec4 heights;
};
static_assert(sizeof(Block) == 64);

/// Twin of Push in cover_columns.comp.
struct Push {
    std::uint32_t block_count, samples, first_row, width, rows, height;
};

/// A range of rows along y of the grid.
struct Slab {
    unsigned first, rows;
};

std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return a >= 0 ? (a + b - 1) / b : -(-a / b); }

class CoverageMaker {
public:
    CoverageMaker(Workspace& workspace, const Volume& grid, std::uint32_t samples)
        : workspace_(workspace), recorder_(workspace.device()), size_(grid.size), samples_(samples),
          coverage_(grid.voxel_count()), blocks_(workspace.device(), "blocks of columns", kMostBlocks * sizeof(Block),
                                                 vk::BufferUsageFlagBits::eStorageBuffer, true) {
        const vk::DeviceSize row = sizeof(std::int32_t) * vk::DeviceSize(size_.x) * size_.z;
        const vk::DeviceSize most = std::min(kMostBytes, workspace.device().max_storage_binding());
        slab_rows_ = unsigned(std::clamp<vk::DeviceSize>(most / row, 1, size_.y));
        using Usage = vk::BufferUsageFlagBits;
        differences_ = Buffer(workspace.device(), "differences of coverage", row * slab_rows_,
                              Usage::eStorageBuffer | Usage::eTransferSrc | Usage::eTransferDst);
        result_ = Buffer(workspace.device(), "coverage", row * slab_rows_, Usage::eTransferDst, true);
    }

    std::vector<float> make(const Mesh& mesh, const glm::mat4& grid_from_mesh) {
        place(mesh, grid_from_mesh);
        for (unsigned first = 0; first < size_.y; first += slab_rows_) {
            const Slab slab{first, std::min(slab_rows_, size_.y - first)};
            recorder_.fill(differences_, 0);
            for (const glm::uvec3& t : mesh.triangles) add(t, slab);
            submit(slab);
            recorder_.copy(differences_, result_, result_.size());
            recorder_.submit_and_wait();
            sum(slab);
        }
        return std::move(coverage_);
    }

private:
    /// Rounds corners to the lattice, and computes their heights in voxels.
    void place(const Mesh& mesh, const glm::mat4& grid_from_mesh) {
        const glm::dmat4 m(grid_from_mesh);
        const double scale = double(kLattice) * samples_;
        corners_.resize(mesh.positions.size());
        heights_.resize(mesh.positions.size());
        for (std::size_t v = 0; v < corners_.size(); ++v) {
            const glm::dvec3 p(m * glm::dvec4(mesh.positions[v], 1.0));
            corners_[v] = glm::ivec2(int(std::lround(scale * p.x)), int(std::lround(scale * p.y)));
            heights_[v] = float(p.z);
        }
        mirrored_ = glm::determinant(glm::dmat3(m)) < 0.0;
    }

    void add(const glm::uvec3& t, const Slab& slab) {
        Block block{corners_[t.x], corners_[t.y], corners_[t.z], {}, {}, -1, 0, {}};
        block.heights = {heights_[t.x], heights_[t.y], heights_[t.z], 0.0f};
        const auto ab = glm::i64vec2(block.b) - glm::i64vec2(block.a),
                   ac = glm::i64vec2(block.c) - glm::i64vec2(block.a);
        const std::int64_t area = ab.x * ac.y - ab.y * ac.x;
        if (area == 0) return;  // parallel to the columns
        if (area < 0) {
            std::swap(block.b, block.c);
            std::swap(block.heights.y, block.heights.z);
        }
        // Seen from the end of the columns, a counter-clockwise triangle shows its outside, so columns leave there.
        block.sign = (area < 0) != mirrored_ ? 1 : -1;
        const glm::i64vec2 low = glm::min(glm::min(block.a, block.b), block.c);
        const glm::i64vec2 high = glm::max(glm::max(block.a, block.b), block.c);
        glm::ivec2 first, last;
        for (int k = 0; k < 2; ++k) {
            first[k] = int(ceil_div(low[k] - kLattice / 2, kLattice));
            last[k] = int(ceil_div(high[k] - kLattice / 2 + 1, kLattice) - 1);
        }
        const int samples = int(samples_);
        first = glm::max(first, glm::ivec2(0, int(slab.first) * samples));
        last = glm::min(last, glm::ivec2(int(size_.x), int(slab.first + slab.rows)) * samples - 1);
        for (int y = first.y; y <= last.y; y += kBlockSide)
            for (int x = first.x; x <= last.x; x += kBlockSide) {
                if (block_count_ == kMostBlocks) submit(slab);
                block.first_column = {x, y};
                block.last_column = glm::min(last, glm::ivec2(x, y) + kBlockSide - 1);
                std::memcpy(blocks_.mapped() + block_count_++ * sizeof(Block), &block, sizeof(Block));
            }
    }

    void submit(const Slab& slab) {
        if (block_count_ == 0) return;
        const Push push{std::uint32_t(block_count_), samples_, slab.first, size_.x, slab.rows, size_.z};
        recorder_.compute(workspace_.compute(shaders::cover_columns_comp),
                          {reads("Blocks", blocks_), updates("Differences", differences_)}, push,
                          {std::uint32_t(block_count_), 1});
        recorder_.submit_and_wait();
        block_count_ = 0;
    }

    /// Sums the differences along the columns.
    void sum(const Slab& slab) {
        const auto* const differences = reinterpret_cast<const std::int32_t*>(result_.mapped());
        const float scale = 1.0f / (float(kFull) * float(samples_ * samples_));
        for_each_parallel(slab.rows, [&](std::size_t row) {
            std::vector<std::int32_t> total(size_.x, 0), so_far(size_.x, 0);
            const auto at = [&](unsigned z) { return differences + size_.x * (row + std::size_t(slab.rows) * z); };
            for (unsigned z = 0; z < size_.z; ++z)
                for (unsigned x = 0; x < size_.x; ++x) total[x] += at(z)[x];
            for (unsigned z = 0; z < size_.z; ++z) {
                float* const to = &coverage_[size_.x * (slab.first + row + std::size_t(size_.y) * z)];
                for (unsigned x = 0; x < size_.x; ++x) {
                    so_far[x] += at(z)[x];
                    // For a column that is left open, take the smaller count of both ends.
                    const std::int32_t inside = std::min(so_far[x], so_far[x] - total[x]);
                    to[x] = std::clamp(scale * float(inside), 0.0f, 1.0f);
                }
            }
        });
    }

    Workspace& workspace_;
    Recorder recorder_;
    glm::uvec3 size_;
    std::uint32_t samples_;
    unsigned slab_rows_ = 1;
    std::vector<float> coverage_;
    Buffer blocks_, differences_, result_;
    std::size_t block_count_ = 0;
    std::vector<glm::ivec2> corners_;
    std::vector<float> heights_;
    bool mirrored_ = false;
};

}  // namespace

std::vector<float> mesh_coverage(Workspace& workspace, const Volume& grid, const Mesh& mesh,
                                 const glm::mat4& grid_from_mesh, std::uint32_t samples) {
    return CoverageMaker(workspace, grid, samples).make(mesh, grid_from_mesh);
}

}  // namespace pellucid
