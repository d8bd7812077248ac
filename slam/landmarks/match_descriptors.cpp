#include "slam/landmarks/match_descriptors.h"

#include <bit>
#include <cstring>

namespace inlay {
namespace {

constexpr double most_ambiguous = 0.93;  // nearest over second nearest difference

/// The nearest of all, and how near the second nearest is.
struct Nearest {
    int index = -1;
    int difference = 257, second = 257;  // bits

    void offer(int candidate, int bits) {
        if (bits < difference) {
            second = difference;
            difference = bits;
            index = candidate;
        } else if (bits < second) {
            second = bits;
        }
    }
    bool distinct() const {
        return difference <= most_different_bits && difference < most_ambiguous * second;
    }
};

}  // namespace

int difference(const LandmarkDescriptor& a, const LandmarkDescriptor& b) {
    int bits = 0;
    for (std::size_t i = 0; i < a.size(); i += 8) {
        std::uint64_t x, y;
        std::memcpy(&x, a.data() + i, 8);
        std::memcpy(&y, b.data() + i, 8);
        bits += std::popcount(x ^ y);
    }
    return bits;
}

std::vector<LandmarkPair> match_descriptors(std::span<const LandmarkDescriptor> from,
                                            std::span<const LandmarkDescriptor> to) {
    std::vector<Nearest> of_from(from.size()), of_to(to.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
        for (std::size_t j = 0; j < to.size(); ++j) {
            const int bits = difference(from[i], to[j]);
            of_from[i].offer(int(j), bits);
            of_to[j].offer(int(i), bits);
        }
    }
    std::vector<LandmarkPair> pairs;
    for (int i = 0; i < int(from.size()); ++i) {
        const Nearest& nearest = of_from[std::size_t(i)];
        if (!nearest.distinct()) continue;
        const Nearest& back = of_to[std::size_t(nearest.index)];
        if (back.index == i && back.distinct()) pairs.push_back({i, nearest.index});
    }
    return pairs;
}

}  // namespace inlay
