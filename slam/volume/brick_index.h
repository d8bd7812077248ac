// BrickIndex: from a brick's position to its number, by open addressing.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace inlay {

/// Whether the coordinates of a brick fit the index: each within +-2^20 (67 km at 8 mm voxels).
bool indexable(const glm::ivec3& key);

/// A map from ivec3 to int that only grows. Keys must be indexable().
class BrickIndex {
public:
    static constexpr int absent = -1;

    /// The number stored for `key`, or absent.
    int find(const glm::ivec3& key) const;
    /// Stores a number for a key that is not there yet.
    void insert(const glm::ivec3& key, int number);
    std::size_t size() const { return size_; }

private:
    struct Slot {
        std::uint64_t key = 0;
        int number = absent;
    };
    std::size_t slot_of(std::uint64_t key) const;
    void grow();

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
};

}  // namespace inlay
