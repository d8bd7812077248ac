// How long the environment filter takes for a frame with every layer filled.
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"
#include "render/filter/environment_bandwidth.h"
#include "render/filter/filter_layers.h"

#include <benchmark/benchmark.h>

namespace inlay {
namespace {

/// A tilted real plane under a virtual ball that fills the middle of the image, with noise.
NoisyLayers ball_on_plane(int width, int height, std::uint32_t frame) {
    const Image<Rgb> black(width, height, Rgb(0));
    const Image<glm::vec3> vectors(width, height, glm::vec3(0));
    const Image<float> numbers(width, height, 0.0f);
    const Image<std::uint32_t> objects(width, height, 0);
    const Receiver nothing{objects, vectors, vectors, numbers, numbers};
    const Irradiance dark{black, black, black};
    const double f = 0.8 * width;
    NoisyLayers n;
    n.lens = {width, height, f, f, 0.5 * width, 0.5 * height};
    n.samples = 16;
    n.m = n.glossy_bandwidth = numbers;
    n.k_v = n.s_rv = black;
    n.direct = n.indirect = dark;
    n.real = n.virtual_ = nothing;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::vec3 ray(unproject(n.lens, {double(x), double(y)}));
            const SampleKey key{1, frame, std::uint32_t(n.m.index(x, y)), 0};
            const Rgb light(1 + uniform(key, 0), 1 + uniform(key, 1), 1 + uniform(key, 2));
            const float radius = 0.25f * float(height);
            const glm::vec2 off = (glm::vec2(x, y) - 0.5f * glm::vec2(width, height)) / radius;
            const bool ball = glm::length(off) < 1;
            const glm::vec3 normal = ball ? glm::vec3(off, -std::sqrt(1 - glm::dot(off, off)))
                                          : glm::normalize(glm::vec3(0, -1, -1));
            Receiver& r = ball ? n.virtual_ : n.real;
            r.object(x, y) = 1;
            r.normal(x, y) = normal;
            r.position(x, y) = ball ? glm::vec3(0, 0, 2) + 0.4f * normal : ray * (2 / (1 + ray.y));
            r.occluder_direct(x, y) = uniform(key, 3) < 0.3f ? 4 * uniform(key, 4) : 0.0f;
            r.occluder_indirect(x, y) = 3 * uniform(key, 5);
            n.m(x, y) = ball ? 0.0f : 1.0f;
            n.glossy_bandwidth(x, y) = ball ? 14.6f : 0.0f;
            for (Irradiance* e : {&n.direct, &n.indirect}) {
                (ball ? e->e_rv_virtual : e->e_r)(x, y) = light;
                if (!ball) e->e_rv_real(x, y) = light * (y > height / 2 ? 0.9f : 1.0f);
            }
            if (ball) n.s_rv(x, y) = light;
        }
    }
    return n;
}

void filter_frame(benchmark::State& state) {
    set_thread_count(int(state.range(0)));
    const NoisyLayers before = ball_on_plane(640, 480, 0), now = ball_on_plane(640, 480, 1);
    for (auto _ : state)
        benchmark::DoNotOptimize(
            filter_layers(now, state.range(1) != 0 ? &before : nullptr, 10, FilterSettings{}));
}
BENCHMARK(filter_frame)
    ->ArgNames({"threads", "temporal"})
    ->ArgsProduct({{1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void bandwidth_of_environment(benchmark::State& state) {
    Image<Rgb> map(4096, 2048, Rgb(0.3f));
    map(1000, 700) = Rgb(1e5f);
    for (auto _ : state)
        benchmark::DoNotOptimize(environment_bandwidth(map));
}
BENCHMARK(bandwidth_of_environment)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace inlay

BENCHMARK_MAIN();
