// A fixed list of light samples: what it draws, and that its error is frozen and right on average.
#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace inlay::test {
namespace {

Image<Rgb> map() { return lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2)); }

/// Irradiance (red) of the normal +y that all the list's samples together give.
double irradiance_of(const EnvironmentSampler& list) {
    double sum = 0;
    for (const LightSample& s : list.list)
        sum += double(s.radiance.r) * std::max(0.0f, s.direction.y) / s.pdf;
    return sum / double(list.list.size());
}

TEST(LightList, ReturnsItsOwnSamplesEachAsOften) {
    const EnvironmentSampler sampler = make_light_list({map(), glm::dmat3(1.0)}, 8, 3);
    ASSERT_EQ(sampler.list.size(), 8U);
    for (int i = 0; i < 64; ++i) {
        const LightSample s = sample_environment(sampler, {(float(i) + 0.5f) / 64, 0.3f});
        EXPECT_EQ(s.direction, sampler.list[std::size_t(i / 8)].direction);
        EXPECT_EQ(s.pdf, sampler.list[std::size_t(i / 8)].pdf);
    }
    EXPECT_EQ(sample_environment(sampler, {std::nextafter(1.0f, 0.0f), 0}).direction,
              sampler.list.back().direction);
}

TEST(LightList, KeepsTheDensityOfTheTables) {
    const EnvironmentSampler list = make_light_list({map(), glm::dmat3(1.0)}, 1024, 3);
    const EnvironmentSampler tables = environment_of(map());
    for (const LightSample& s : list.list)
        EXPECT_EQ(pdf_environment(list, s.direction), pdf_environment(tables, s.direction));
    EXPECT_EQ(list.mean_luminance, tables.mean_luminance);
}

/// Student's t over seeds against the irradiance that 2^20 draws from the tables give.
TEST(LightList, IsRightOnAverageOverSeeds) {
    const EnvironmentSampler tables = environment_of(map());
    RunningMean truth;
    for (std::uint32_t i = 0; i < 1U << 20; ++i) {
        const LightSample s = sample_environment(tables, stratified_pair({1, 0, 0, i}, 0));
        truth.add(double(s.radiance.r) * std::max(0.0f, s.direction.y) / s.pdf);
    }
    RunningMean lists;
    for (std::uint32_t seed = 0; seed < 100; ++seed)
        lists.add(irradiance_of(make_light_list({map(), glm::dmat3(1.0)}, 256, seed)));
    EXPECT_TRUE(has_mean(lists, truth.mean));
}

TEST(LightList, HasAFrozenErrorThatFallsWithItsLength) {
    const auto spread = [](int length) {
        RunningMean lists;
        for (std::uint32_t seed = 0; seed < 40; ++seed)
            lists.add(irradiance_of(make_light_list({map(), glm::dmat3(1.0)}, length, seed)));
        return lists.variance();
    };
    // 16 times the length lowers the variance 16 times or more; 40 values tell a variance to 23 %.
    EXPECT_LT(spread(4096), spread(256) / 8);
    EXPECT_GT(spread(4096), 0);
}

TEST(LightList, IsDecidedByItsSeedAndRefusesNoLength) {
    const EnvironmentMap light{map(), glm::dmat3(1.0)};
    EXPECT_EQ(make_light_list(light, 16, 1).list[5].direction,
              make_light_list(light, 16, 1).list[5].direction);
    EXPECT_NE(make_light_list(light, 16, 1).list[5].direction,
              make_light_list(light, 16, 2).list[5].direction);
    EXPECT_THROW(make_light_list(light, 0, 1), Error);
}

}  // namespace
}  // namespace inlay::test
