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

Floats BrickGrid::read(const Ints& brick, const Ints& slot) const {
    const auto bricks = numbers_of(brick), slots = numbers_of(slot);
    return Floats([&](auto lane) {
        return table_[std::size_t(bricks[lane])]->distance[std::size_t(slots[lane])];
    });
}

BrickGrid::Axis BrickGrid::axis(const Ints& low, int which) const {
    const Ints a = stdx::clamp(low, Ints(0), Ints(size_[which] * brick_side - 2)), b = a + 1;
    const Ints brick = stride_[std::size_t(which)], slot = slot_stride[std::size_t(which)];
    return {{(a >> 3) * brick, (b >> 3) * brick}, {(a & 7) * slot, (b & 7) * slot}};
}

Floats BrickGrid::nearest_distance(const Vectors& p) const {
    const auto nearest = [](const Floats& x) { return whole(stdx::floor(x + 0.5f)); };
    const Axis x = axis(nearest(p.x), 0), y = axis(nearest(p.y), 1), z = axis(nearest(p.z), 2);
    return read(x.brick[0] + y.brick[0] + z.brick[0], x.slot[0] + y.slot[0] + z.slot[0]);
}

Floats BrickGrid::distance(const Vectors& p) const {
    const Vectors base{stdx::floor(p.x), stdx::floor(p.y), stdx::floor(p.z)};
    const Axis x = axis(whole(base.x), 0), y = axis(whole(base.y), 1), z = axis(whole(base.z), 2);
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
    const Floats here = distance(p);
    const Lanes here_known = here < 1.5f;
    Lanes known(true);
    const auto slope = [&](const Vectors& step) {
        const Floats ahead = distance({p.x + step.x, p.y + step.y, p.z + step.z});
        const Floats behind = distance({p.x - step.x, p.y - step.y, p.z - step.z});
        const Lanes ahead_known = ahead < 1.5f, behind_known = behind < 1.5f;
        const Lanes both = ahead_known && behind_known;
        known = known && (both || (here_known && (ahead_known || behind_known)));
        const Floats one_sided = choose(ahead_known, ahead - here, here - behind);
        return choose(both, (ahead - behind) * 0.5f, one_sided);
    };
    const Vectors g{slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1})};
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
