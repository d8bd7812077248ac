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

}  // namespace
}  // namespace inlay::test
