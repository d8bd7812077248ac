#include "apps/bench/filter_arithmetic.h"

#include "recordings/base/parallel.h"
#include "render/filter/filter_weight.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace inlay {
namespace {

/// The pixels of a row that the kernels run over.
struct Span {
    int begin = 0, end = 0;
};

std::vector<Span> occupied_spans(const Image<std::uint32_t>& object) {
    std::vector<Span> spans;
    for (int y = 0; y < object.height; ++y) {
        Span span{object.width, 0};
        for (int x = 0; x < object.width; ++x)
            if (object(x, y) != 0) span = {std::min(span.begin, x), x + 1};
        spans.push_back(span);
    }
    return spans;
}

/// Of one kernel over the pixels with an object.
KernelWork kernel_over(const Image<std::uint32_t>& object, int channels, bool with_previous,
                       int radius) {
    const std::vector<Span> spans = occupied_spans(object);
    double within_rows = 0, to_previous = 0, down_columns = 0;  // weights
    for (int y = 0; y < object.height; ++y) {
        const Span& span = spans[std::size_t(y)];
        for (int i = -radius; i <= radius; ++i) {
            const int pairs = std::max(0, span.end - span.begin - std::abs(i));
            if (i > 0) within_rows += pairs;
            if (with_previous) to_previous += pairs;
            if (i == 0 || y + i < 0 || y + i >= object.height) continue;
            const Span& other = spans[std::size_t(y + i)];
            down_columns +=
                std::max(0, std::min(span.end, other.end) - std::max(span.begin, other.begin));
        }
    }
    const double sums = 2 * within_rows + to_previous + down_columns;  // a row's weight serves both
    return {within_rows + to_previous + down_columns, channels * sums};
}

constexpr std::size_t run = 256;  // px

/// Two runs of pixels and a channel, small enough for the nearest cache.
struct Block {
    std::array<std::array<float, run>, 14> surfaces{};  // positions, normals, precisions
    std::array<std::uint32_t, run> object{};
    std::array<float, run> weights{}, own{}, other{}, sums{};

    PixelRun pixels(std::size_t first) const {
        const auto at = [&](std::size_t i) { return surfaces[first + i].data(); };
        return {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, at(6), object.data()};
    }
};

void multiply_add(float* __restrict sums, const float* weights, const float* other,
                  const float* own) {
    for (std::size_t k = 0; k < run; ++k)
        sums[k] += weights[k] * (other[k] - own[k]);
}

}  // namespace

KernelWork kernel_work(const NoisyLayers& now, bool with_previous, const FilterSettings& settings) {
    Image<std::uint32_t> glossy = now.virtual_.object;
    for (std::size_t i = 0; i < glossy.pixels.size(); ++i)
        if (now.glossy_bandwidth.pixels[i] == 0) glossy.pixels[i] = 0;
    const int radius = settings.kernel_radius;
    KernelWork all = kernel_over(glossy, 3, /*with_previous=*/false, radius);
    const KernelWork real = kernel_over(now.real.object, 6, with_previous, radius);
    const KernelWork on_virtual = kernel_over(now.virtual_.object, 3, with_previous, radius);
    for (const KernelWork& light : {real, on_virtual, real, on_virtual}) {  // direct and indirect
        all.weights += light.weights;
        all.multiply_adds += light.multiply_adds;
    }
    return all;
}

std::function<void()> arithmetic(const KernelWork& work) {
    constexpr int shares = 64;
    const auto turns = [](double count) { return int(std::lround(count / double(run * shares))); };
    return [weighings = turns(work.weights), additions = turns(work.multiply_adds)] {
        parallel_for(shares, [&](int) {
            Block block;
            for (int i = 0; i < weighings; ++i) {
                weigh(block.pixels(0), block.pixels(7), int(run), 0.98f, block.weights.data());
                benchmark::ClobberMemory();
            }
            for (int i = 0; i < additions; ++i) {
                multiply_add(block.sums.data(), block.weights.data(), block.other.data(),
                             block.own.data());
                benchmark::ClobberMemory();
            }
            benchmark::DoNotOptimize(block);
        });
    };
}

}  // namespace inlay
