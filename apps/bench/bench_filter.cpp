// How long the environment filter takes for a frame with every layer filled, beside going through
// its memory once and beside the arithmetic of its kernels alone.
#include "recordings/base/keep_memory.h"
#include "recordings/base/random.h"
#include "render/filter/environment_bandwidth.h"
#include "render/filter/filter_layers.h"

#include "apps/bench/best_times.h"
#include "apps/bench/filter_arithmetic.h"
#include "apps/bench/streaming.h"
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <string>

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

/// Everything that filter_layers() has to read and to write at least once, in whole images.
Traffic traffic_of(const NoisyLayers& now, const NoisyLayers* previous, const Layers& filtered) {
    Traffic traffic;
    traffic.reads(now.m), traffic.reads(now.k_v), traffic.reads(now.s_rv);
    traffic.reads(now.glossy_bandwidth);
    for (const NoisyLayers* n : {&now, previous}) {
        if (n == nullptr) continue;
        for (const Irradiance* e : {&n->direct, &n->indirect})
            traffic.reads(e->e_r), traffic.reads(e->e_rv_real), traffic.reads(e->e_rv_virtual);
        for (const Receiver* r : {&n->real, &n->virtual_}) {
            traffic.reads(r->object), traffic.reads(r->position), traffic.reads(r->normal);
            traffic.reads(r->occluder_direct), traffic.reads(r->occluder_indirect);
        }
    }
    traffic.writes(filtered.m), traffic.writes(filtered.k_v), traffic.writes(filtered.s_rv);
    for (const Irradiance* e : {&filtered.direct, &filtered.indirect})
        traffic.writes(e->e_r), traffic.writes(e->e_rv_real), traffic.writes(e->e_rv_virtual);
    traffic.writes(filtered.bandwidth_direct), traffic.writes(filtered.bandwidth_indirect);
    return traffic;
}

std::string filter_name(bool temporal, int threads) {
    return std::string("filter") + (temporal ? " with the frame before" : "") + "/" +
           std::to_string(threads);
}

/// The filter, and what no filter of its kernels can do without.
void add_filter(const NoisyLayers& now, const NoisyLayers* previous, int threads) {
    const FilterSettings settings;
    const auto filter = [&now, previous, settings] {
        return filter_layers(now, previous, 10, settings);
    };
    const Traffic traffic = traffic_of(now, previous, filter());
    const KernelWork work = kernel_work(now, previous != nullptr, settings);
    const std::string name = filter_name(previous != nullptr, threads);
    add_benchmark(name, threads, {}, [filter] { benchmark::DoNotOptimize(filter()); });
    add_benchmark(name + "/its bytes alone", threads, {"bytes", bytes_of(traffic)},
                  streaming(traffic));
    add_benchmark(name + "/its arithmetic alone", threads, {"weights", work.weights},
                  arithmetic(work));
}

int run(int argc, char** argv) {
    keep_freed_memory();
    const NoisyLayers before = ball_on_plane(640, 480, 0), now = ball_on_plane(640, 480, 1);
    constexpr std::size_t copied = 64 << 20;  // bytes, more than caches hold
    for (const int threads : {1, 2}) {
        for (const NoisyLayers* previous : {static_cast<const NoisyLayers*>(nullptr), &before})
            add_filter(now, previous, threads);
        add_benchmark("copy/" + std::to_string(threads), threads, {"bytes", 2.0 * copied},
                      copying(copied));
    }
    Image<Rgb> map(4096, 2048, Rgb(0.3f));
    map(1000, 700) = Rgb(1e5f);
    add_benchmark("bandwidth of environment", 1, {},
                  [&] { benchmark::DoNotOptimize(environment_bandwidth(map)); });

    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    std::cout << "\n";
    for (const bool temporal : {false, true}) {
        for (const int threads : {1, 2}) {
            const std::string name = filter_name(temporal, threads);
            print_ratio(name, name + "/its bytes alone");
            print_ratio(name, name + "/its arithmetic alone");
        }
        print_ratio(filter_name(temporal, 1), filter_name(temporal, 2));
    }
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace inlay

int main(int argc, char** argv) { return inlay::run(argc, argv); }
