#include "slam/volume/brick_grid.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <limits>

namespace inlay {
namespace {

constexpr std::array<int, 3> slot_stride{1, brick_side, brick_side* brick_side};

constexpr double most_entries = 1 << 27;  // 1 GB
constexpr float least_share = 0.5f;  // of the voxels around a point, by weight, that must be known

const Brick& absent_brick() {
    static const Brick brick = [] {
        Brick absent;
        absent.distance.fill(absent_distance);
        return absent;
    }();
    return brick;
}

Ints whole(const Floats& x) { return stdx::static_simd_cast<Ints>(x); }

}  // namespace

BrickGrid::BrickGrid(const VoxelVolume& volume, std::span<const int> bricks) {
    glm::ivec3 lowest(0), highest(-1);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        const glm::ivec3& key = volume.keys[std::size_t(bricks[i])];
        lowest = i == 0 ? key : glm::min(lowest, key);
        highest = i == 0 ? key : glm::max(highest, key);
    }
    origin_ = (lowest - 1) * brick_side;
    size_ = highest - lowest + 3;
    const double entries = double(size_.x) * double(size_.y) * double(size_.z);
    require(entries <= most_entries,
            "the model's bricks in view span more than fits a table: take larger voxels "
            "(slam.fusion.voxel_size) or a nearer slam.raycast.farthest",
            ExitCode::usage);
    stride_ = {1, size_.x, size_.x * size_.y};
    table_.assign(std::size_t(entries), &absent_brick());
    for (const int number : bricks) {
        const Brick& brick = volume.bricks[std::size_t(number)];
        const glm::ivec3 at = brick.key - lowest + 1;
        table_[std::size_t(at.x + at.y * stride_[1] + at.z * stride_[2])] = &brick;
    }
}

template <std::size_t Count>
BrickGrid::Axis<Count> BrickGrid::axis(const Ints& low, int which) const {
    const auto axis_number = std::size_t(which);
    const Ints bricks = stride_[axis_number], slots = slot_stride[axis_number];
    const Ints first = stdx::clamp(low, Ints(0), Ints(size_[which] * brick_side - int(Count)));
    Axis<Count> result;
    for (std::size_t i = 0; i < Count; ++i) {
        const Ints voxel = first + int(i);
        result.brick[i] = (voxel >> 3) * bricks;
        result.slot[i] = (voxel & 7) * slots;
    }
    return result;
}

Floats BrickGrid::nearest_distance(const Vectors& p) const {
    const auto nearest = [](const Floats& x) { return whole(stdx::floor(x + 0.5f)); };
    const Axis x = axis<1>(nearest(p.x), 0), y = axis<1>(nearest(p.y), 1),
               z = axis<1>(nearest(p.z), 2);
    return read(x.brick[0] + y.brick[0] + z.brick[0], x.slot[0] + y.slot[0] + z.slot[0]);
}

/// A mean over those of some voxels that are known.
struct KnownMean {
    Floats sum = 0, share = 0;

    void add(const Floats& weight, const Floats& distance) {
        const Lanes known = distance < 1.5f;
        where(known, sum) += weight * distance;
        where(known, share) += weight;
    }
    /// Adds the rise from a voxel to its neighbor.
    void add_rise(const Floats& weight, const Floats& from, const Floats& to) {
        const Lanes known = from < 1.5f && to < 1.5f;
        where(known, sum) += weight * (to - from);
        where(known, share) += weight;
    }
    /// unknown_distance where too little is known.
    Floats value() const {
        const Lanes known = share >= least_share;
        return choose(known, sum / choose(known, share, 1), unknown_distance);
    }
};

Floats BrickGrid::distance(const Vectors& p) const {
    const Vectors base{stdx::floor(p.x), stdx::floor(p.y), stdx::floor(p.z)};
    const Axis x = axis<2>(whole(base.x), 0), y = axis<2>(whole(base.y), 1),
               z = axis<2>(whole(base.z), 2);
    const Vectors f{p.x - base.x, p.y - base.y, p.z - base.z};
    const std::array<Floats, 2> wx{1 - f.x, f.x}, wy{1 - f.y, f.y}, wz{1 - f.z, f.z};
    KnownMean mean;
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Ints bricks = y.brick[j] + z.brick[k], slots = y.slot[j] + z.slot[k];
            for (std::size_t i = 0; i < 2; ++i)
                mean.add(wx[i] * wy[j] * wz[k], read(x.brick[i] + bricks, x.slot[i] + slots));
        }
    }
    return mean.value();
}

Vectors BrickGrid::gradient(const Vectors& p) const {
    const Vectors base{stdx::floor(p.x), stdx::floor(p.y), stdx::floor(p.z)};
    const std::array<Floats, 3> f{p.x - base.x, p.y - base.y, p.z - base.z};
    const std::array<Axis<4>, 3> around{axis<4>(whole(base.x) - 1, 0),
                                        axis<4>(whole(base.y) - 1, 1),
                                        axis<4>(whole(base.z) - 1, 2)};
    const auto at = [&](const std::array<std::size_t, 3>& i) {
        return read(around[0].brick[i[0]] + around[1].brick[i[1]] + around[2].brick[i[2]],
                    around[0].slot[i[0]] + around[1].slot[i[1]] + around[2].slot[i[2]]);
    };
    std::array<Floats, 8> core;  // the voxels around the points, x fastest
    for (std::size_t c = 0; c < core.size(); ++c)
        core[c] = at({1 + (c & 1), 1 + ((c >> 1) & 1), 1 + (c >> 2)});
    Lanes known(true);
    const auto slope = [&](std::size_t axis) {
        const std::size_t second = (axis + 1) % 3, third = (axis + 2) % 3;
        KnownMean mean;
        for (std::size_t side = 0; side < 4; ++side) {  // four lines of four voxels along the axis
            std::array<std::size_t, 3> first{};
            first[second] = 1 + (side & 1);
            first[third] = 1 + (side >> 1);
            auto last = first;
            last[axis] = 3;
            const std::size_t inner = ((side & 1) << second) + ((side >> 1) << third);
            const Floats d1 = core[inner], d2 = core[inner + (std::size_t(1) << axis)];
            const Floats line = 0.5f * ((side & 1) ? f[second] : 1 - f[second]) *
                                ((side >> 1) ? f[third] : 1 - f[third]);
            mean.add_rise(line * (1 - f[axis]), at(first), d1);
            mean.add_rise(line, d1, d2);
            mean.add_rise(line * f[axis], d2, at(last));
        }
        const Floats rise = mean.value();
        known = known && rise < 1.5f;
        return rise;
    };
    const Vectors g{slope(0), slope(1), slope(2)};
    return {choose(known, g.x, 0), choose(known, g.y, 0), choose(known, g.z, 0)};
}

float BrickGrid::nearest_weight(const glm::vec3& p) const {
    const glm::ivec3 voxel =
        glm::clamp(glm::ivec3(glm::floor(p + 0.5f)), glm::ivec3(0), size_ * brick_side - 1);
    const glm::ivec3 brick = voxel >> 3;
    const int entry = brick.x + brick.y * stride_[1] + brick.z * stride_[2];
    return table_[std::size_t(entry)]->weight[std::size_t(slot_in_brick(voxel))];
}

}  // namespace inlay
