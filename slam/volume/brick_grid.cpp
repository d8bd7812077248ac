#include "slam/volume/brick_grid.h"

#include <algorithm>
#include <limits>

namespace inlay {
namespace {

constexpr std::array<int, 3> slot_stride{1, brick_side, brick_side * brick_side};

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
        const glm::ivec3& key = volume.bricks[std::size_t(bricks[i])].key;
        lowest = i == 0 ? key : glm::min(lowest, key);
        highest = i == 0 ? key : glm::max(highest, key);
    }
    origin_ = (lowest - 1) * brick_side;
    size_ = highest - lowest + 3;
    stride_ = {1, size_.x, size_.x * size_.y};
    table_.assign(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z),
                  &absent_brick());
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

Floats BrickGrid::distance(const Vectors& p) const {
    const Vectors base{stdx::floor(p.x), stdx::floor(p.y), stdx::floor(p.z)};
    const Axis x = axis<2>(whole(base.x), 0), y = axis<2>(whole(base.y), 1),
               z = axis<2>(whole(base.z), 2);
    const Vectors f{p.x - base.x, p.y - base.y, p.z - base.z};
    const std::array<Floats, 2> wx{1 - f.x, f.x}, wy{1 - f.y, f.y}, wz{1 - f.z, f.z};
    Floats sum = 0, largest = -1;
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Ints bricks = y.brick[j] + z.brick[k], slots = y.slot[j] + z.slot[k];
            for (std::size_t i = 0; i < 2; ++i) {
                const Floats d = read(x.brick[i] + bricks, x.slot[i] + slots);
                sum += wx[i] * wy[j] * wz[k] * d;
                largest = stdx::max(largest, d);
            }
        }
    }
    return choose(largest < 1.5f, sum, unknown_distance);
}

Vectors BrickGrid::gradient(const Vectors& p) const {
    const Vectors base{stdx::floor(p.x), stdx::floor(p.y), stdx::floor(p.z)};
    const Vectors f{p.x - base.x, p.y - base.y, p.z - base.z};
    const std::array<Axis<4>, 3> around{axis<4>(whole(base.x) - 1, 0), axis<4>(whole(base.y) - 1, 1),
                                        axis<4>(whole(base.z) - 1, 2)};
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k) {
        return read(around[0].brick[i] + around[1].brick[j] + around[2].brick[k],
                    around[0].slot[i] + around[1].slot[j] + around[2].slot[k]);
    };
    const std::array<std::array<Floats, 2>, 3> weight{
        {{1 - f.x, f.x}, {1 - f.y, f.y}, {1 - f.z, f.z}}};
    std::array<Floats, 8> core;  // the voxels around the points, x fastest
    for (std::size_t c = 0; c < core.size(); ++c)
        core[c] = at(1 + (c & 1), 1 + ((c >> 1) & 1), 1 + (c >> 2));
    Lanes known(true);
    const auto slope = [&](std::size_t which) {
        // The distances one voxel behind and one ahead, each trilinear, as layers across the axis.
        std::array<Floats, 4> layer;
        std::array<Floats, 4> largest;
        layer.fill(0);
        largest.fill(-1);
        const std::size_t second = (which + 1) % 3, third = (which + 2) % 3;
        for (std::size_t n = 0; n < 4; ++n) {
            for (std::size_t side = 0; side < 4; ++side) {
                std::array<std::size_t, 3> corner{};
                corner[second] = side & 1;
                corner[third] = side >> 1;
                Floats d;
                if (n == 1 || n == 2) {
                    corner[which] = n - 1;
                    d = core[corner[0] + 2 * corner[1] + 4 * corner[2]];
                } else {
                    corner[second] += 1;
                    corner[third] += 1;
                    corner[which] = n;
                    d = at(corner[0], corner[1], corner[2]);
                }
                layer[n] += weight[second][side & 1] * weight[third][side >> 1] * d;
                largest[n] = stdx::max(largest[n], d);
            }
        }
        const Floats low = weight[which][0], high = weight[which][1];
        const Floats behind = low * layer[0] + high * layer[1];
        const Floats here = low * layer[1] + high * layer[2];
        const Floats ahead = low * layer[2] + high * layer[3];
        const Lanes middle = stdx::max(largest[1], largest[2]) < 1.5f;
        const Lanes back = largest[0] < 1.5f, front = largest[3] < 1.5f;
        known = known && middle && (back || front);
        const Floats one_sided = choose(front, ahead - here, here - behind);
        return choose(back && front, (ahead - behind) * 0.5f, one_sided);
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
