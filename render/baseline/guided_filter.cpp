// Linear fits from box sums, in double precision, so that constants come back to the bit.
#include "render/baseline/guided_filter.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/baseline/smooth_receivers.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace inlay {
namespace {

constexpr int columns_at_once = 64;

/// `count` places along a line, at each of which `lanes` neighbors in memory are summed alike.
struct Line {
    int count = 0, step = 0, lanes = 1;
    double* at(double* image, int i) const { return image + std::ptrdiff_t(i) * step; }
};

/// Replaces every value by the sum over the `radius` places before and after it, as far as the line
/// goes. Sums run forwards and backwards within blocks as long as a window, so that a window is the
/// end of one block and the beginning of the next: nothing outside of it leaves a rounding error in
/// its sum, as what enters and leaves a running sum would.
void window_sums(double* image, const Line& line, int radius) {
    const int length = 2 * radius + 1, lanes = line.lanes;
    std::vector<double> ahead(std::size_t(line.count) * std::size_t(lanes)), back(ahead.size());
    const auto add = [&](std::vector<double>& sums, int i, int neighbor, bool first) {
        for (int k = 0; k < lanes; ++k)
            sums[std::size_t(i * lanes + k)] =
                line.at(image, i)[k] + (first ? 0.0 : sums[std::size_t(neighbor * lanes + k)]);
    };
    for (int i = 0; i < line.count; ++i)
        add(ahead, i, i - 1, i % length == 0);
    for (int i = line.count - 1; i >= 0; --i)
        add(back, i, i + 1, i == line.count - 1 || (i + 1) % length == 0);
    for (int i = 0; i < line.count; ++i) {
        const int first = std::max(0, i - radius), last = std::min(line.count - 1, i + radius);
        const bool split = first / length != last / length;
        const bool whole = first % length == 0;  // from the beginning of its block
        for (int k = 0; k < lanes; ++k) {
            const double end = ahead[std::size_t(last * lanes + k)];
            const double begin = back[std::size_t(first * lanes + k)];
            line.at(image, i)[k] = split ? begin + end : (whole ? end : begin);
        }
    }
}

/// Sums over squares of `radius` px around each pixel, as far as they lie within the image.
void box_sum(Image<double>& image, int radius) {
    parallel_rows(image.height, [&](int y) {
        window_sums(&image(0, y), {image.width, 1, 1}, radius);
    });
    const int blocks = (image.width + columns_at_once - 1) / columns_at_once;
    parallel_for(blocks, [&](int block) {
        const int begin = block * columns_at_once;
        const int lanes = std::min(columns_at_once, image.width - begin);
        window_sums(&image(begin, 0), {image.height, image.width, lanes}, radius);
    });
}

/// Box sums of what all channels share, and the inverse of each square's covariance of normals.
struct Guide {
    const FilterPlanes& planes;
    int radius;
    Image<double> count;
    std::array<Image<double>, 3> normal;  // means
    Image<glm::dmat3> inverse_covariance;

    Guide(const FilterPlanes& p, int r, double epsilon);
    glm::dvec3 normal_at(std::size_t i) const {
        const auto& n = planes.surface->normal;
        return {n[0].pixels[i], n[1].pixels[i], n[2].pixels[i]};
    }
    bool has(std::size_t i) const { return planes.object.pixels[i] != 0; }
    /// value(i) summed over each pixel's square.
    template <class Value>
    Image<double> sums_of(Value value) const {
        Image<double> result(planes.object.width, planes.object.height, 0.0);
        parallel_rows(result.height, [&](int y) {
            const std::size_t begin = result.index(0, y);
            for (std::size_t i = begin; i < begin + std::size_t(result.width); ++i)
                if (has(i)) result.pixels[i] = value(i);
        });
        box_sum(result, radius);
        return result;
    }
};

Guide::Guide(const FilterPlanes& p, int r, double epsilon) : planes(p), radius(r) {
    count = sums_of([](std::size_t) { return 1.0; });
    std::array<Image<double>, 6> products;
    for (int a = 0, k = 0; a < 3; ++a) {
        normal[std::size_t(a)] = sums_of([&](std::size_t i) { return normal_at(i)[a]; });
        for (int b = a; b < 3; ++b)
            products[std::size_t(k++)] =
                sums_of([&](std::size_t i) { return normal_at(i)[a] * normal_at(i)[b]; });
    }
    inverse_covariance = Image<glm::dmat3>(planes.object.width, planes.object.height);
    parallel_rows(count.height, [&](int y) {
        const std::size_t begin = count.index(0, y);
        for (std::size_t i = begin; i < begin + std::size_t(count.width); ++i) {
            if (!has(i)) continue;
            for (Image<double>& n : normal)
                n.pixels[i] /= count.pixels[i];
            glm::dmat3 covariance(epsilon);
            for (int a = 0, k = 0; a < 3; ++a) {
                for (int b = a; b < 3; ++b, ++k) {
                    const double c =
                        products[std::size_t(k)].pixels[i] / count.pixels[i] -
                        normal[std::size_t(a)].pixels[i] * normal[std::size_t(b)].pixels[i];
                    covariance[a][b] += c;
                    if (a != b) covariance[b][a] += c;
                }
            }
            inverse_covariance.pixels[i] = glm::inverse(covariance);
        }
    });
}

/// Replaces a channel by the mean of the fits that reach each pixel.
void smooth_channel(const Guide& guide, Image<float>& channel) {
    const auto value = [&](std::size_t i) { return double(channel.pixels[i]); };
    const Image<double> mean = guide.sums_of(value);
    std::array<Image<double>, 4> fit;  // a . n + b: sums of value times normal, then a; b
    for (int c = 0; c < 3; ++c)
        fit[std::size_t(c)] =
            guide.sums_of([&](std::size_t i) { return value(i) * guide.normal_at(i)[c]; });
    fit[3] = Image<double>(channel.width, channel.height, 0.0);
    const auto each_row = [&](auto&& body) {
        parallel_rows(channel.height, [&](int y) {
            const std::size_t begin = channel.index(0, y);
            for (std::size_t i = begin; i < begin + std::size_t(channel.width); ++i)
                body(i);
        });
    };
    each_row([&](std::size_t i) {
        glm::dvec4 result(0.0);
        if (guide.has(i)) {
            const double count = guide.count.pixels[i], p = mean.pixels[i] / count;
            const glm::dvec3 n{guide.normal[0].pixels[i], guide.normal[1].pixels[i],
                               guide.normal[2].pixels[i]};
            const glm::dvec3 products{fit[0].pixels[i], fit[1].pixels[i], fit[2].pixels[i]};
            const glm::dvec3 a = guide.inverse_covariance.pixels[i] * (products / count - p * n);
            result = {a, p - glm::dot(a, n)};
        }
        for (int c = 0; c < 4; ++c)
            fit[std::size_t(c)].pixels[i] = result[c];
    });
    for (Image<double>& f : fit)
        box_sum(f, guide.radius);
    each_row([&](std::size_t i) {
        if (!guide.has(i)) return;
        const glm::dvec3 a{fit[0].pixels[i], fit[1].pixels[i], fit[2].pixels[i]};
        const double sum = glm::dot(a, guide.normal_at(i)) + fit[3].pixels[i];
        channel.pixels[i] = float(std::max(sum / guide.count.pixels[i], 0.0));
    });
}

}  // namespace

Layers guided_filter(const NoisyLayers& now, int radius, double epsilon) {
    require(radius >= 1 && radius <= 1000,
            "the guided filter's radius is " + std::to_string(radius) + ", expected 1 to 1000 px",
            ExitCode::usage);
    require_width(epsilon, "the guided filter's epsilon");
    return smooth_receivers(now, {}, [&](FilterPlanes& planes) {
        const Guide guide(planes, radius, epsilon);
        for (Image<float>& channel : planes.channels)
            smooth_channel(guide, channel);
    });
}

}  // namespace inlay
