// Glossy lobes: reflected directions come as often as pdf_glossy says, from several views.
#include "recordings/base/random.h"
#include "render/scatter/bsdf.h"
#include "tests/support/chi_square.h"
#include "tests/support/mean_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace inlay::test {
namespace {

struct LobeCase {
    std::string name;
    Material material;
};

/// A metal whose GGX alphas are given; materials hold their square roots.
Material metal(float alpha_x, float alpha_y) {
    return Ggx{Rgb(1), glm::sqrt(glm::vec2(alpha_x, alpha_y)), 1, nullptr};
}

std::vector<LobeCase> lobe_cases() {
    return {{"phong 1", Phong{Rgb(0), Rgb(1), 1}},
            {"phong 16", Phong{Rgb(0), Rgb(1), 16}},
            {"phong 256", Phong{Rgb(0), Rgb(1), 256}},
            {"ggx 0.02", metal(0.02f, 0.02f)},
            {"ggx 0.1", metal(0.1f, 0.1f)},
            {"ggx 0.5", metal(0.5f, 0.5f)},
            {"ggx 1", metal(1, 1)},
            {"ggx 0.8 x 0.1", metal(0.8f, 0.1f)},
            {"ggx 0.05 x 0.3", metal(0.05f, 0.3f)}};
}

class LobeChiSquare : public ::testing::TestWithParam<double> {};

TEST_P(LobeChiSquare, FollowsItsDensity) {
    const double theta = GetParam() * std::numbers::pi / 180, phi = 0.6;
    const glm::vec3 viewer(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                           std::cos(theta));
    const ScatterFrame frame = scatter_frame({0, 0, 1}, viewer);
    const DirectionGrid grid{32, 64, 0};  // about the normal: the horizon is the grid's edge
    for (const LobeCase& c : lobe_cases()) {
        const Bsdf bsdf = bsdf_at(c.material, {0, 0}, 1);
        const double p = sampling_p_value(
            grid, 100000,
            [&](int i) {
                const SampleKey key{5, 0, std::uint32_t(i), 0};
                const DirectionSample s =
                    sample_glossy(bsdf, frame, {uniform(key, 0), uniform(key, 1)});
                return s.pdf > 0 ? glm::dvec3(s.direction) : glm::dvec3(0);
            },
            [&](const glm::dvec3& d) { return double(pdf_glossy(bsdf, frame, d)); });
        EXPECT_TRUE(plausible(p)) << c.name << ", viewed at " << GetParam() << " degrees";
    }
}

INSTANTIATE_TEST_SUITE_P(ViewsDeg, LobeChiSquare, ::testing::Values(0.0, 35.0, 65.0, 85.0));

}  // namespace
}  // namespace inlay::test
