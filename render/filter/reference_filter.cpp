// Direct two-dimensional sums.
#include "render/filter/reference_filter.h"

#include "recordings/base/parallel.h"

#include <glm/glm.hpp>

#include <cmath>

namespace inlay {
namespace {

struct PixelPair {
    const FilterPlanes &a, &b;
    std::size_t at_a, at_b;
    int columns, rows;  // from a to b
};

double sum_at(const Image<float>& a, const Image<float>& b, const PixelPair& pair) {
    return double(a.pixels[pair.at_a]) + double(b.pixels[pair.at_b]);
}

double weight(const PixelPair& pair, double normal_cosine) {
    const auto object = pair.a.object.pixels[pair.at_a];
    if (object == 0 || object != pair.b.object.pixels[pair.at_b]) return 0;
    double square = 0, cosine = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = double(pair.b.surface->position[i].pixels[pair.at_b]) -
                         double(pair.a.surface->position[i].pixels[pair.at_a]);
        square += d * d;
        cosine += double(pair.a.surface->normal[i].pixels[pair.at_a]) *
                  double(pair.b.surface->normal[i].pixels[pair.at_b]);
    }
    if (cosine < normal_cosine) return 0;
    const double i2 = double(pair.columns) * pair.columns, j2 = double(pair.rows) * pair.rows;
    const double along_x = i2 + j2 > 0 ? i2 / (i2 + j2) : 0.5;
    const double precision = along_x * sum_at(pair.a.precision_x, pair.b.precision_x, pair) +
                             (1 - along_x) * sum_at(pair.a.precision_y, pair.b.precision_y, pair);
    return std::exp(-0.25 * precision * square);
}

/// Adds a frame's pixels around (x, y) of `now` to the sums of weights and weighted values.
void add_frame(const FilterPlanes& now, const FilterPlanes& frame, glm::ivec2 at,
               const KernelSettings& kernel, std::vector<double>& sums) {
    for (int j = -kernel.radius; j <= kernel.radius; ++j) {
        for (int i = -kernel.radius; i <= kernel.radius; ++i) {
            if (!frame.object.contains(at.x + i, at.y + j)) continue;
            const std::size_t b = frame.object.index(at.x + i, at.y + j);
            const double w = weight({now, frame, now.object.index(at.x, at.y), b, i, j},
                                    double(kernel.normal_cosine));
            sums[0] += w;
            for (std::size_t c = 0; c < frame.channels.size(); ++c)
                sums[1 + c] += w * double(frame.channels[c].pixels[b]);
        }
    }
}

}  // namespace

std::vector<Image<float>> filter_reference(const FilterPlanes& now, const FilterPlanes* previous,
                                           const KernelSettings& kernel) {
    const Image<float> blank(now.object.width, now.object.height, 0.0f);
    std::vector<Image<float>> result(now.channels.size(), blank);
    parallel_rows(blank.height, [&](int y) {
        for (int x = 0; x < blank.width; ++x) {
            if (now.object(x, y) == 0) continue;
            std::vector<double> sums(1 + result.size(), 0.0);
            add_frame(now, now, {x, y}, kernel, sums);
            if (previous != nullptr) add_frame(now, *previous, {x, y}, kernel, sums);
            for (std::size_t c = 0; c < result.size(); ++c)
                result[c](x, y) = float(sums[1 + c] / sums[0]);
        }
    });
    return result;
}

}  // namespace inlay
