#include "slam/volume/brick_index.h"

#include <cassert>
#include <cstdlib>

namespace inlay {
namespace {

constexpr int bits = 21;  // per coordinate
constexpr int bound = 1 << (bits - 1);

std::uint64_t packed(const glm::ivec3& key) {
    const auto part = [](int i) { return std::uint64_t(i + bound) & ((1U << bits) - 1); };
    return (part(key.x) << (2 * bits)) | (part(key.y) << bits) | part(key.z);
}

/// Mixes the bits of a 64-bit word (the finalizer of splitmix64; Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

}  // namespace

bool indexable(const glm::ivec3& key) {
    const auto fits = [](int i) { return i >= -bound && i < bound; };
    return fits(key.x) && fits(key.y) && fits(key.z);
}

std::size_t BrickIndex::slot_of(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mixed(key) & mask;
    while (slots_[slot].number != absent && slots_[slot].key != key)
        slot = (slot + 1) & mask;
    return slot;
}

int BrickIndex::find(const glm::ivec3& key) const {
    return slots_.empty() ? absent : slots_[slot_of(packed(key))].number;
}

void BrickIndex::insert(const glm::ivec3& key, int number) {
    assert(indexable(key) && find(key) == absent);
    if (2 * (size_ + 1) > slots_.size()) grow();
    slots_[slot_of(packed(key))] = {packed(key), number};
    ++size_;
}

void BrickIndex::grow() {
    std::vector<Slot> old(slots_.empty() ? 1024 : 2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
        if (slot.number != absent) slots_[slot_of(slot.key)] = slot;
    }
}

}  // namespace inlay
