// Light nets: well spread runs of the environment's samples.
#include "render/sample/light_nets.h"

#include "recordings/base/check.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace inlay::test {
namespace {

/// Any 2^k aligned samples of a net hold one in each of 2^k slices of the first number, which a
/// constant map turns into slices of equal height along its axis.
TEST(LightNets, AlignedPartsOfANetSpreadOverTheSphere) {
    const LightNets nets = make_light_nets(constant_environment(1), 64, {1, 2, 0, 0});
    ASSERT_EQ(nets.size, 64);
    for (const std::uint32_t net : {0u, 7u, 255u}) {
        for (const int part : {4, 16, 64}) {
            for (int first = 0; first < nets.size; first += part) {
                std::vector<int> slices(std::size_t(part), 0);
                for (int i = first; i < first + part; ++i) {
                    const float y = nets.at(net, 64, i).direction.y;
                    const int slice = int((1 - y) / 2 * float(part) * 0.99999f);
                    ++slices[std::size_t(slice)];
                }
                EXPECT_EQ(*std::max_element(slices.begin(), slices.end()), 1) << part;
            }
        }
    }
}

TEST(LightNets, SizesArePowersOfTwoAndRunsFollowEachOtherAndRepeat) {
    const EnvironmentSampler sky = constant_environment(1);
    EXPECT_EQ(make_light_nets(sky, 1, {}).size, 1);
    EXPECT_EQ(make_light_nets(sky, 48, {}).size, 64);
    EXPECT_EQ(make_light_nets(sky, 1 << 20, {}).size, 4096);
    EXPECT_GE(make_light_nets(sky, 4096, {}).samples.size(), 256u * 4096);
    const LightNets nets = make_light_nets(sky, 48, {});
    const auto runs = std::uint32_t(nets.samples.size() / 16);
    EXPECT_EQ(nets.at(3, 16, 5).direction, nets.at(3 + runs, 16, 5).direction);
    EXPECT_EQ(nets.at(3, 16, 16).direction, nets.at(4, 16, 0).direction);
    EXPECT_EQ(nets.at(4, 16, 0).direction, nets.at(1, 64, 0).direction);
    EXPECT_THROW(make_light_nets(sky, 0, {}), Error);
}

TEST(LightNets, TheKeyDecidesAndFramesDiffer) {
    const EnvironmentSampler sky = constant_environment(1);
    const LightNets a = make_light_nets(sky, 16, {1, 5, 0, 0});
    const LightNets again = make_light_nets(sky, 16, {1, 5, 0, 0});
    EXPECT_EQ(a.at(9, 16, 3).direction, again.at(9, 16, 3).direction);
    EXPECT_NE(a.at(9, 16, 3).direction,
              make_light_nets(sky, 16, {1, 6, 0, 0}).at(9, 16, 3).direction);
}

TEST(LightNets, WithoutLightThereIsOneAndNothingInIt) {
    const LightNets nets = make_light_nets(constant_environment(0), 16, {});
    EXPECT_EQ(nets.samples.size(), 16u);
}

}  // namespace
}  // namespace inlay::test
