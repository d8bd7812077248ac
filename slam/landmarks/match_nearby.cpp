#include "slam/landmarks/match_nearby.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr float reach = 0.025f;       // rad
constexpr float depth_reach = 0.08f;  // of depth
constexpr float nearest = 0.05f;      // m, from the camera

/// Where a landmark is seen.
struct Sight {
    glm::vec2 direction{0};  // x / z, y / z
    float z = 0;             // m
    int index = 0;
};

Sight sight_of(const glm::vec3& p, int index) { return {{p.x / p.z, p.y / p.z}, p.z, index}; }

std::vector<Sight> sights_by_x(const Landmarks& landmarks) {
    std::vector<Sight> sights;
    for (int i = 0; i < int(landmarks.position.size()); ++i)
        sights.push_back(sight_of(landmarks.position[std::size_t(i)], i));
    std::stable_sort(sights.begin(), sights.end(),
                     [](const Sight& a, const Sight& b) { return a.direction.x < b.direction.x; });
    return sights;
}

bool near(const Sight& a, const Sight& b) {
    const glm::vec2 off = a.direction - b.direction;
    return glm::dot(off, off) < reach * reach && std::abs(a.z - b.z) < depth_reach * a.z;
}

struct MostAlike {
    int index = -1;
    int difference = most_different_bits + 1;  // bits

    void offer(int candidate, int bits) {
        if (bits < difference) *this = {candidate, bits};
    }
};

/// Calls visit(index) for the sights near to one.
template <class Visit>
void for_nearby(const std::vector<Sight>& by_x, const Sight& expected, const Visit& visit) {
    const float first = expected.direction.x - reach, last = expected.direction.x + reach;
    auto sight = std::lower_bound(by_x.begin(), by_x.end(), first,
                                  [](const Sight& s, float x) { return s.direction.x < x; });
    for (; sight != by_x.end() && sight->direction.x < last; ++sight) {
        if (near(*sight, expected)) visit(std::size_t(sight->index));
    }
}

}  // namespace

std::vector<LandmarkPair> match_nearby(const Landmarks& from, const Landmarks& to,
                                       const Pose& from_to) {
    const std::vector<Sight> sights = sights_by_x(from);
    std::vector<MostAlike> of_from(from.position.size()), of_to(to.position.size());
    for (std::size_t j = 0; j < to.position.size(); ++j) {
        const glm::vec3 moved(from_to * glm::dvec3(to.position[j]));
        if (!(moved.z > nearest)) continue;
        for_nearby(sights, sight_of(moved, int(j)), [&](std::size_t i) {
            const int bits = difference(from.descriptor[i], to.descriptor[j]);
            of_from[i].offer(int(j), bits);
            of_to[j].offer(int(i), bits);
        });
    }
    std::vector<LandmarkPair> pairs;
    for (int i = 0; i < int(of_from.size()); ++i) {
        const int j = of_from[std::size_t(i)].index;
        if (j >= 0 && of_to[std::size_t(j)].index == i) pairs.push_back({i, j});
    }
    return pairs;
}

}  // namespace inlay
