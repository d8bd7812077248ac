#include "slam/mesh/brick_field.h"

#include <algorithm>

namespace inlay {
namespace {

using Bits = BrickField::Plane<std::uint8_t>;

const Brick& absent_brick() {
    static const Brick brick;
    return brick;
}

void find_bricks(const VoxelVolume& volume, const glm::ivec3& key, BrickField& field) {
    std::size_t entry = 0;
    for (int k = -1; k <= 1; ++k) {
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i, ++entry) {
                const Brick* brick = find_brick(volume, key + glm::ivec3(i, j, k));
                field.bricks[entry] = brick ? brick : &absent_brick();
            }
        }
    }
}

void copy_distances(BrickField& field) {
    float* to = field.distance.data();
    for (int k = -1; k < field_side - 1; ++k) {
        for (int j = -1; j < field_side - 1; ++j, to += field_side) {
            const int row = 9 * ((k + brick_side) >> 3) + 3 * ((j + brick_side) >> 3);
            const Brick* const* bricks = &field.bricks[std::size_t(row)];
            const int slot = slot_in_brick({0, j, k});
            const auto from = [&](int i) { return bricks[i]->distance.data() + slot; };
            to[0] = from(0)[brick_side - 1];
            std::copy_n(from(1), brick_side, to + 1);
            std::copy_n(from(2), field_side - brick_side - 1, to + 1 + brick_side);
        }
    }
}

/// Joins what holds for an entry with what holds for the one `step` further.
template <int step>
void join(Bits& all, Bits& any) {
    for (std::size_t i = 0; i + step < all.size(); ++i) {
        all[i] &= all[i + step];
        any[i] |= any[i + step];
    }
}

void tell_cells(BrickField& field) {
    constexpr int seen = cell_known, inside = cell_crossed;
    Bits all, any;  // of the eight voxels of a cell
    for (std::size_t i = 0; i < all.size(); ++i) {
        const float d = field.distance[i];
        all[i] = any[i] = std::uint8_t((is_known(d) ? seen : 0) | (d < 0 ? inside : 0));
    }
    join<BrickField::stride[0]>(all, any);
    join<BrickField::stride[1]>(all, any);
    join<BrickField::stride[2]>(all, any);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const int known = all[i] & seen, mixed = any[i] & ~all[i] & inside;
        field.cell[i] = std::uint8_t(known != 0 ? known | mixed : 0);
    }
}

}  // namespace

std::array<VoxelPlace, 8> BrickField::places(const glm::ivec3& v) const {
    constexpr glm::ivec3 brick_stride(1, 3, 9), slot_stride(1, brick_side, brick_side * brick_side);
    const glm::ivec3 low = v - first + (brick_side - 1), high = low + 1;
    const std::array<glm::ivec3, 2> brick{(low >> 3) * brick_stride, (high >> 3) * brick_stride};
    const std::array<glm::ivec3, 2> slot{(low & 7) * slot_stride, (high & 7) * slot_stride};
    std::array<VoxelPlace, 8> result;
    for (std::size_t c = 0; c < result.size(); ++c) {
        const std::size_t i = c & 1, j = (c >> 1) & 1, k = c >> 2;
        const int number = brick[i].x + brick[j].y + brick[k].z;
        const int entry = slot[i].x + slot[j].y + slot[k].z;
        result[c] = {bricks[std::size_t(number)], std::size_t(entry)};
    }
    return result;
}

BrickField brick_field(const VoxelVolume& volume, const Brick& brick) {
    BrickField field;
    field.first = brick.key * brick_side - 1;
    find_bricks(volume, brick.key, field);
    copy_distances(field);
    tell_cells(field);
    return field;
}

}  // namespace inlay
