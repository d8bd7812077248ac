// Stratified pairs: every prefix of 2^k samples is a (0, k, 2)-net, whatever the key.
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace inlay::test {
namespace {

/// Cells of 2^a x 2^b that hold exactly one of the samples.
int occupied_cells(const SampleKey& pixel, int samples, int columns, int rows) {
    std::set<int> cells;
    for (int i = 0; i < samples; ++i) {
        SampleKey key = pixel;
        key.sample = std::uint32_t(i);
        const glm::vec2 u = stratified_pair(key, 3);
        EXPECT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
        cells.insert(int(u.y * float(rows)) * columns + int(u.x * float(columns)));
    }
    return int(cells.size());
}

TEST(StratifiedPair, EveryElementaryIntervalHoldsOnePoint) {
    for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
        for (const int samples : {4, 16, 64, 256}) {
            for (int columns = 1; columns <= samples; columns *= 2)
                EXPECT_EQ(occupied_cells({1, 2, pixel, 0}, samples, columns, samples / columns),
                          samples);
        }
    }
}

TEST(StratifiedPair, EveryPartOfTheKeyChangesTheNumbers) {
    const SampleKey key{1, 2, 3, 4};
    std::vector<SampleKey> others(4, key);
    ++others[0].seed, ++others[1].frame, ++others[2].pixel, ++others[3].sample;
    for (const SampleKey& other : others)
        EXPECT_NE(stratified_pair(key, 0), stratified_pair(other, 0));
    EXPECT_NE(stratified_pair(key, 0), stratified_pair(key, 1));
    EXPECT_EQ(stratified_pair(key, 0), stratified_pair(key, 0));
}

TEST(RunOf, PixelsFollowEachOtherInPowersOfTwo) {
    const StratifiedSet all = frame_set({1, 2, 0, 0}, 3);
    EXPECT_EQ(run_of(all, 2, 5).at(1), all.at(17));  // 5 points take the room of 8
    EXPECT_EQ(run_of(all, 0, 1).at(7), all.at(7));
    EXPECT_EQ(run_of(all, 1U << 31, 4).at(3), all.at(3));  // after 2^32 points the first again
    EXPECT_EQ(frame_set({1, 2, 9, 8}, 3).at(4), all.at(4));
}

TEST(RunOf, NeighborsAreSpreadTogether) {
    for (const int per_pixel : {1, 4, 16}) {
        for (const std::uint32_t pixels : {4u, 16u, 64u}) {
            const int points = int(pixels) * per_pixel;
            for (int columns = 1; columns <= points; columns *= 2) {
                std::set<int> cells;
                for (std::uint32_t p = 0; p < pixels; ++p) {
                    for (int i = 0; i < per_pixel; ++i) {
                        const SampleKey key{1, 2, 900 + p, std::uint32_t(i), 5 * pixels + p};
                        const glm::vec2 u =
                            run_of(frame_set(key, 3), key.place, per_pixel).at(key.sample);
                        cells.insert(int(u.y * float(points / columns)) * columns +
                                     int(u.x * float(columns)));
                    }
                }
                EXPECT_EQ(int(cells.size()), points) << per_pixel << " in " << pixels;
            }
        }
    }
}

TEST(PlaceAlongCurve, KeepsSquaresTogether) {
    for (const std::uint32_t side : {2u, 4u, 16u}) {
        std::set<std::uint32_t> places;
        for (std::uint32_t y = 0; y < side; ++y)
            for (std::uint32_t x = 0; x < side; ++x)
                places.insert(place_along_curve(3 * side + x, 5 * side + y));
        EXPECT_EQ(places.size(), side * side);
        EXPECT_EQ(*places.rbegin() - *places.begin(), side * side - 1);
        EXPECT_EQ(*places.begin() % (side * side), 0u);
    }
    EXPECT_EQ(place_along_curve(65535, 65535), 0xffffffffU);
}

}  // namespace
}  // namespace inlay::test
