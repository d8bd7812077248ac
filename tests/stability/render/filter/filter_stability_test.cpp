// Hard inputs: results stay finite and within the input's range, no invalid operation happens on
// the way, and threads do not matter.
#include "recordings/base/parallel.h"
#include "render/filter/bandlimits.h"
#include "render/filter/environment_bandwidth.h"
#include "render/filter/filter_layers.h"
#include "tests/support/filter_scenes.h"
#include "tests/support/floating_point_traps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace inlay {
namespace {

using namespace test;

constexpr double spacing = 0.02;  // m
constexpr float infinity = std::numeric_limits<float>::infinity();

/// On one thread, since other threads have their own traps.
struct FloatTraps {
    FloatTraps() { set_thread_count(1); }
    ~FloatTraps() { set_thread_count(0); }

    FloatingPointTraps traps;
};

/// Every value is finite and between 0 and `largest`.
void expect_bounded(const Layers& layers, float largest) {
    const auto check = [&](const Image<Rgb>& image, const char* name) {
        for (const Rgb& v : image.pixels) {
            for (int c = 0; c < 3; ++c) {
                ASSERT_TRUE(std::isfinite(v[c])) << name;
                ASSERT_GE(v[c], -1e-6f * largest) << name;
                ASSERT_LE(v[c], (1 + 1e-5f) * largest) << name;
            }
        }
    };
    for (const Irradiance* light : {&layers.direct, &layers.indirect}) {
        check(light->e_r, "e_r");
        check(light->e_rv_real, "e_rv_real");
        check(light->e_rv_virtual, "e_rv_virtual");
    }
    check(layers.s_rv, "s_rv");
    for (const Image<float>* b : {&layers.bandwidth_direct, &layers.bandwidth_indirect}) {
        for (const float v : b->pixels)
            ASSERT_TRUE(std::isfinite(v) && v >= 0);
    }
}

NoisyLayers plane_and_ball(int width, int height, std::uint32_t seed) {
    NoisyLayers layers = noisy_plane(width, height, spacing, seed);
    add_ball(layers, 0.3 * spacing * std::min(width, height), seed + 10);
    return layers;
}

struct HardCase {
    const char* name;
    float largest;  // value that may come out
    std::function<void(NoisyLayers&)> spoil;
};

/// One pixel of both receivers.
void at_centre(NoisyLayers& n, const std::function<void(Receiver&, int, int)>& change) {
    for (Receiver* r : {&n.real, &n.virtual_})
        change(*r, n.lens.width / 2, n.lens.height / 2);
}

void every_rate(NoisyLayers& n, float rate) {
    for (Receiver* r : {&n.real, &n.virtual_}) {
        for (float& c : r->occluder_direct.pixels)
            c = rate;
        for (float& c : r->occluder_indirect.pixels)
            c = rate;
    }
}

void every_light(NoisyLayers& n, const Rgb& e_r, const Rgb& e_rv) {
    for (Irradiance* light : {&n.direct, &n.indirect}) {
        for (Rgb& e : light->e_r.pixels)
            e = e_r;
        for (Rgb& e : light->e_rv_real.pixels)
            e = e_rv;
    }
}

const HardCase hard_cases[] = {
    {"no light", 1, [](auto& n) { every_light(n, Rgb(0), Rgb(0)); }},
    {"light in one mode", 1, [](auto& n) { every_light(n, Rgb(0), Rgb(1e-3f)); }},
    {"hardly any light", 1, [](auto& n) { every_light(n, Rgb(1e-38f), Rgb(1e-38f)); }},
    {"no bandwidth", 1, [](auto& n) { every_rate(n, 0); }},
    {"infinite bandwidth", 1, [](auto& n) { every_rate(n, infinity); }},
    {"rates that are no numbers", 1, [](auto& n) { every_rate(n, NAN); }},
    {"negative rates", 1, [](auto& n) { every_rate(n, -1); }},
    {"an occluder at a micrometre", 1, [](auto& n) { every_rate(n, 1e6f); }},
    {"glossy bandwidth infinite or no number", 1,
     [](auto& n) {
         for (std::size_t i = 0; i < n.m.pixels.size(); ++i)
             n.glossy_bandwidth.pixels[i] = i % 2 == 0 ? infinity : NAN;
     }},
    {"all positions the same", 1,
     [](auto& n) {
         for (glm::vec3& p : n.real.position.pixels)
             p = glm::vec3(0.1f);
         for (std::size_t i = 0; i < n.m.pixels.size(); ++i)
             n.real.normal.pixels[i] = glm::vec3(i % 2 == 0 ? 1 : 0, 0, i % 2 == 0 ? 0 : 1);
     }},
    {"opposite normals", 1,
     [](auto& n) {
         for (std::size_t i = 0; i < n.m.pixels.size(); ++i)
             n.real.normal.pixels[i] = glm::vec3(0, 0, i % 2 == 0 ? 1 : -1);
     }},
    {"normals without length", 1,
     [](auto& n) { at_centre(n, [](auto& r, int x, int y) { r.normal(x, y) = glm::vec3(0); }); }},
    {"a normal that is no number", 1,
     [](auto& n) { at_centre(n, [](auto& r, int x, int y) { r.normal(x, y).y = NAN; }); }},
    {"a position that is no number", 1,
     [](auto& n) { at_centre(n, [](auto& r, int x, int y) { r.position(x, y).z = NAN; }); }},
    {"a position at infinity", 1,
     [](auto& n) { at_centre(n, [](auto& r, int x, int y) { r.position(x, y).x = infinity; }); }},
    {"a position beyond every scene", 1,
     [](auto& n) { at_centre(n, [](auto& r, int x, int y) { r.position(x, y).x = 1e38f; }); }},
    {"a surface at the camera", 1,
     [](auto& n) {
         at_centre(n, [](auto& r, int x, int y) {
             r.position(x, y) = glm::vec3(0, 0, float(camera_height));
         });
     }},
    {"light that is no number", 1,
     [](auto& n) { n.direct.e_r(1, 0) = n.indirect.e_rv_real(0, 0) = Rgb(NAN, 1, infinity); }},
    {"glossy light that is no number", 1,
     [](auto& n) { n.s_rv(n.lens.width / 2, n.lens.height / 2) = Rgb(NAN); }},
    {"one very bright value", 2e30f, [](auto& n) { n.direct.e_r(1, 1) = Rgb(9e29f); }},
    {"no receiver at all", 1,
     [](auto& n) {
         for (Receiver* r : {&n.real, &n.virtual_}) {
             for (std::uint32_t& o : r->object.pixels)
                 o = 0;
         }
     }},
    {"holes like a chessboard", 1,
     [](auto& n) {
         for (std::size_t i = 0; i < n.m.pixels.size(); i += 2)
             n.real.object.pixels[i] = 0;
     }},
    {"every pixel an object of its own", 1,
     [](auto& n) {
         for (std::size_t i = 0; i < n.m.pixels.size(); ++i)
             n.real.object.pixels[i] = std::uint32_t(i + 1);
     }},
    {"no samples", 1, [](auto& n) { n.samples = 0; }},
    {"a quarter covered", 1,
     [](auto& n) {
         for (float& m : n.m.pixels)
             m = 0.25f;
     }},
    {"the virtual surface upon the real one", 1,
     [](auto& n) {
         n.virtual_ = n.real;
         n.direct.e_rv_virtual = n.direct.e_r;
     }},
};

TEST(FloatTrapsDeathTest, EndTheProgramOnAnInvalidOperation) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            const FloatTraps traps;
            volatile float nothing = 0;
            nothing = nothing / nothing;
        },
        "");
}

TEST(FilterStability, HardInputsGiveBoundedNumbersWithoutAnInvalidOperation) {
    for (const HardCase& hard : hard_cases) {
        SCOPED_TRACE(hard.name);
        NoisyLayers now = plane_and_ball(37, 29, 1), before = plane_and_ball(37, 29, 2);
        hard.spoil(now);
        Layers alone, after_clean, after_same;
        {
            const FloatTraps traps;
            alone = filter_layers(now, nullptr, 26, {});
            after_clean = filter_layers(now, &before, 26, {});
            hard.spoil(before);
            after_same = filter_layers(now, &before, 26, {});
        }
        expect_bounded(alone, hard.largest);
        expect_bounded(after_clean, hard.largest);
        expect_bounded(after_same, hard.largest);
    }
}

TEST(FilterStability, AValueThatIsNoNumberHarmsNobodyElse) {
    NoisyLayers now = noisy_plane(37, 29, spacing, 3);
    NoisyLayers hole = now;
    now.direct.e_r(18, 14) = Rgb(NAN);
    hole.real.object(18, 14) = 0;
    const Layers a = filter_layers(now, nullptr, 10, {}), b = filter_layers(hole, nullptr, 10, {});
    EXPECT_TRUE(same_bits(a.direct, b.direct));
}

TEST(FilterStability, AnySizeWorksWithAKernelLargerThanTheImage) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), {1, 40}, {40, 1}, {2, 3}, {9, 8}}) {
        const NoisyLayers now = plane_and_ball(size.x, size.y, 4);
        const NoisyLayers before = plane_and_ball(size.x, size.y, 5);
        FilterSettings s;
        s.kernel_radius = 100;
        Layers smooth;
        {
            const FloatTraps traps;
            smooth = filter_layers(now, &before, 10, s);
        }
        expect_bounded(smooth, 1);
    }
}

TEST(FilterStability, FramesOfAnotherSizeOrWithoutOverlapAreHarmless) {
    const NoisyLayers now = plane_and_ball(37, 29, 6);
    NoisyLayers behind = plane_and_ball(37, 29, 7);
    behind.world_from_camera.rotation[2] *= -1;  // looks away
    behind.world_from_camera.rotation[0] *= -1;
    const NoisyLayers smaller = plane_and_ball(12, 50, 8);
    const FloatTraps traps;
    const Layers alone = filter_layers(now, nullptr, 10, {});
    EXPECT_TRUE(same_bits(filter_layers(now, &behind, 10, {}), alone));
    const Layers with_smaller = filter_layers(now, &smaller, 10, {});
    EXPECT_TRUE(std::isfinite(with_smaller.direct.e_r(18, 14).x));
}

TEST(FilterStability, ThreadsDoNotChangeAByte) {
    const NoisyLayers now = plane_and_ball(120, 90, 9), before = plane_and_ball(120, 90, 10);
    Image<Rgb> map(300, 150, Rgb(0.2f));
    map(20, 30) = Rgb(90, 80, 70);
    set_thread_count(1);
    const double bandwidth = environment_bandwidth(map);
    const Layers one = filter_layers(now, &before, 10, {});
    for (const int threads : {2, 3}) {
        set_thread_count(threads);
        EXPECT_EQ(environment_bandwidth(map), bandwidth);
        EXPECT_TRUE(same_bits(filter_layers(now, &before, 10, {}), one));
    }
    set_thread_count(0);
}

TEST(FilterStability, WidthsChangeContinuouslyWithTheOccluder) {
    // one part in a thousand more occlusion moves no pixel by more than that part of the noise
    NoisyLayers now = noisy_plane(40, 30, spacing, 11);
    every_rate(now, 1.0f);
    const Layers a = filter_layers(now, nullptr, 10, {});
    every_rate(now, 1.001f);
    const Layers b = filter_layers(now, nullptr, 10, {});
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i)
        EXPECT_NEAR(a.direct.e_r.pixels[i].x, b.direct.e_r.pixels[i].x, 1e-3);
}

TEST(BandwidthStability, FormulasAreFiniteOnExtremes) {
    const double extremes[] = {0, 1e-300, 1e-6, 1, 1e6, 1e9};
    const FloatTraps traps;
    FilterSettings thesis;
    thesis.constants = FilterConstants::thesis;
    for (const double kappa : extremes) {
        for (const double c : extremes) {
            for (const double limit : {0.0, 4.0, 63.0, 1e9}) {
                for (const double sign : {-1.0, 1.0}) {
                    const LocalFrequencies f{sign * kappa, c, limit, limit};
                    for (const LightKind kind : {LightKind::direct, LightKind::indirect}) {
                        EXPECT_TRUE(std::isfinite(inverse_width(f, kind, {})));
                        EXPECT_TRUE(std::isfinite(inverse_width(f, kind, thesis)));
                    }
                    EXPECT_GE(direct_bandwidth(f), 0);
                    EXPECT_GE(indirect_bandwidth(f), 0);
                }
            }
        }
    }
}

TEST(BandwidthStability, EnvironmentsOfAnyKindHaveANumber) {
    Image<Rgb> nothing(64, 32, Rgb(0)), broken(64, 32, Rgb(1)), pole(64, 32, Rgb(1));
    broken(3, 3) = Rgb(NAN);
    broken(9, 9) = Rgb(infinity);
    pole(5, 0) = Rgb(5e4f);
    const FloatTraps traps;
    EXPECT_EQ(environment_bandwidth(nothing), 0);
    for (const Image<Rgb>* map : {&broken, &pole}) {
        const double b = environment_bandwidth(*map);
        EXPECT_GT(b, 0);
        EXPECT_LT(b, environment_degrees);
    }
}

}  // namespace
}  // namespace inlay
