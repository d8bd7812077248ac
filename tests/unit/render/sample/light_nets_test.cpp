// Light nets: well spread runs of the environment's samples, and well spread neighbors.
#include "render/sample/light_nets.h"

#include "recordings/base/check.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace inlay::test {
namespace {

SampleKey key_at(std::uint32_t place, std::uint32_t pixel = 5) { return {1, 2, pixel, 0, place}; }

/// In which of `parts` slices of equal height a direction lies: a constant map turns slices of the
/// first number into these.
int slice_of(const LightSample& sample, int parts) {
    return std::min(int((1 - double(sample.direction.y)) / 2 * parts), parts - 1);
}

/// The most samples that any of as many slices holds.
int crowd(const std::vector<int>& slices) {
    std::vector<int> held(slices.size(), 0);
    for (const int slice : slices)
        ++held[std::size_t(slice)];
    return *std::max_element(held.begin(), held.end());
}

TEST(LightNets, EveryRunSpreadsOverTheSphere) {
    const LightNets nets = make_light_nets(constant_environment(1), 64, {1, 2, 0, 0, 0});
    for (const int length : {4, 16, 64}) {
        for (const std::uint32_t place : {0u, 7u, 12345u, 4000000u}) {
            const LightRun run = nets.run(key_at(place), 3, length);
            std::vector<int> slices;
            for (int i = 0; i < length; ++i)
                slices.push_back(slice_of(nets.at(run, i), length));
            EXPECT_EQ(crowd(slices), 1) << length << " at " << place;
        }
    }
}

/// 4^k pixels that are a square of the image lie together along the curve; each takes its run, and
/// all together have one sample in each slice.
TEST(LightNets, RunsOfNeighborsSpreadTogether) {
    const LightNets nets = make_light_nets(constant_environment(1), 64, {1, 2, 0, 0, 0});
    for (const int length : {4, 16}) {
        for (const std::uint32_t pixels : {4u, 16u, 64u}) {
            const std::uint32_t begin = 3 * pixels;
            std::vector<int> slices;
            for (std::uint32_t p = begin; p < begin + pixels; ++p) {
                const LightRun run = nets.run(key_at(p, 100 + p), 3, length);
                for (int i = 0; i < length; ++i)
                    slices.push_back(slice_of(nets.at(run, i), int(pixels) * length));
            }
            EXPECT_EQ(crowd(slices), 1) << length << " in " << pixels;
        }
    }
}

/// A pixel that takes one sample of its run takes any of the run's 16: 4096 pixels leave none out.
TEST(LightNets, FirstSamplesOfRunsAreAnyOfThem) {
    const LightNets nets = make_light_nets(constant_environment(1), 16, {1, 2, 0, 0, 0});
    std::set<std::size_t> in_run;
    for (std::uint32_t p = 0; p < 4096; ++p)
        in_run.insert(nets.place_of(nets.run(key_at(p, p), 3, 16), 0) % 16);
    EXPECT_EQ(in_run.size(), 16u);
}

/// Nets have a largest size; what takes more goes on in the next.
TEST(LightNets, RunsLongerThanANetStayWithin) {
    for (const float light : {0.0f, 1.0f}) {
        const LightNets nets = make_light_nets(constant_environment(light), 8192, {1, 2, 0, 0, 0});
        for (const int length : {nets.size, 2 * nets.size, 8 * nets.size}) {
            for (const std::uint32_t place : {0u, 5u, 4000000u}) {
                const LightRun run = nets.run(key_at(place), 3, length);
                EXPECT_LT(run.first, nets.samples.size());
                EXPECT_EQ(run.first % std::size_t(nets.size), 0u);
                EXPECT_LT(run.order, std::uint32_t(nets.size));
                std::set<std::size_t> places;
                for (int i = 0; i < nets.size; ++i)
                    places.insert(nets.place_of(run, i));
                EXPECT_EQ(places.size(), std::size_t(nets.size));
            }
        }
    }
}

TEST(LightNets, HoldManyRunsOfAnyLength) {
    const EnvironmentSampler sky = constant_environment(1);
    EXPECT_EQ(make_light_nets(sky, 1, {}).samples.size(), 32768u);
    EXPECT_GE(make_light_nets(sky, 4096, {}).samples.size(), 256u * 4096);
    EXPECT_EQ(make_light_nets(sky, 1 << 20, {}).samples.size(), 256u * 4096);
    EXPECT_THROW(make_light_nets(sky, 0, {}), Error);
}

TEST(LightNets, BeyondARunTheNextFollows) {
    const LightNets nets = make_light_nets(constant_environment(1), 16, {});
    const LightRun run{32, 0}, next{48, 0}, last{nets.samples.size() - 16, 0};
    EXPECT_EQ(nets.at(run, 16).direction, nets.at(next, 0).direction);
    EXPECT_EQ(nets.at(last, 16).direction, nets.samples[0].direction);
}

TEST(LightNets, EightFromAMultipleOfEightOnStandTogether) {
    const LightNets nets = make_light_nets(constant_environment(1), 64, {1, 2, 0, 0, 0});
    const LightRun run = nets.run(key_at(77, 9), 3, 64);
    for (int begin = 0; begin < 64; begin += 8) {
        const std::size_t first = nets.first_of_eight(run, begin);
        std::set<std::size_t> places;
        for (int i = begin; i < begin + 8; ++i)
            places.insert(nets.place_of(run, i));
        EXPECT_EQ(*places.begin(), first);
        EXPECT_EQ(*places.rbegin(), first + 7);
        EXPECT_EQ(nets.direction[1][first], nets.samples[first].direction.y);
    }
}

TEST(LightNets, TheKeyDecidesAndFramesDiffer) {
    const EnvironmentSampler sky = constant_environment(1);
    const LightNets a = make_light_nets(sky, 16, {1, 5, 0, 0, 0});
    const LightNets again = make_light_nets(sky, 16, {1, 5, 0, 0, 0});
    const LightNets next = make_light_nets(sky, 16, {1, 6, 0, 0, 0});
    const auto sample = [](const LightNets& nets, std::uint32_t dimension) {
        return nets.at(nets.run(key_at(9), dimension, 16), 3).direction;
    };
    EXPECT_EQ(sample(a, 3), sample(again, 3));
    EXPECT_NE(sample(a, 3), sample(next, 3));
    EXPECT_NE(sample(a, 3), sample(a, 4));
}

TEST(LightNets, WithoutLightThereIsOneRunAndNothingInIt) {
    const LightNets nets = make_light_nets(constant_environment(0), 16, {});
    EXPECT_EQ(nets.samples.size(), 16u);
    EXPECT_EQ(nets.run(key_at(1000), 3, 16).first, 0u);
}

}  // namespace
}  // namespace inlay::test
