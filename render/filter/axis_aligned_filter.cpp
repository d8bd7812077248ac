// Row pass and column pass; the inner loops run along a row, over arrays of plain numbers.
#include "render/filter/axis_aligned_filter.h"

#include "recordings/base/parallel.h"
#include "render/filter/filter_weight.h"

#include <algorithm>
#include <utility>

namespace inlay {
namespace {

/// The pixels of a row from its first with an object to its last.
struct Span {
    int begin = 0, end = 0;
};

std::vector<Span> occupied_spans(const Image<std::uint32_t>& object) {
    std::vector<Span> spans(std::size_t(object.height), Span{});
    parallel_rows(object.height, [&](int y) {
        const auto row = object.row(y);
        Span span{0, object.width};
        while (span.begin < span.end && row[std::size_t(span.begin)] == 0)
            ++span.begin;
        while (span.begin < span.end && row[std::size_t(span.end - 1)] == 0)
            --span.end;
        spans[std::size_t(y)] = span;
    });
    return spans;
}

/// Sums of one row: of the weights, and per channel of weight times difference.
struct RowSums {
    int width;
    std::vector<float> sums;     // (1 + channels) x width
    std::vector<float> weights;  // of the pairs at hand

    RowSums(int w, std::size_t channels)
        : width(w), sums((1 + channels) * std::size_t(w), 0.0f), weights(std::size_t(w), 0.0f) {}
    float* of_weights() { return sums.data(); }
    float* of_channel(std::size_t c) { return sums.data() + (1 + c) * std::size_t(width); }
};

void add_weights(float* __restrict sum, const float* weights, int count) {
    for (int k = 0; k < count; ++k)
        sum[k] += weights[k];
}

void add_differences(float* __restrict sum, const float* weights, const float* other,
                     const float* own, int count) {
    for (int k = 0; k < count; ++k)
        sum[k] += weights[k] * (other[k] - own[k]);
}

/// Adds `count` pairs, whose weights are at hand, to the sums of the pixels from `x` on; `own` and
/// `other` are where the pixels and their partners begin in the two frames' images.
void add_pairs(RowSums& row, int x, int count, const std::vector<const float*>& own,
               const std::vector<const float*>& other) {
    const float* weights = row.weights.data();
    add_weights(row.of_weights() + x, weights, count);
    for (std::size_t c = 0; c < own.size(); ++c)
        add_differences(row.of_channel(c) + x, weights, other[c], own[c], count);
}

/// Where the channels' pixel (x, y) is.
void point_to(const std::vector<Image<float>>& channels, std::size_t at,
              std::vector<const float*>& pointers) {
    for (std::size_t c = 0; c < channels.size(); ++c)
        pointers[c] = channels[c].pixels.data() + at;
}

struct Filter {
    FilterPlanes& now;
    const FilterPlanes* previous;
    const KernelSettings& kernel;
    std::vector<Span> spans;

    std::vector<Image<float>> smoothed;  // by the row pass
    Image<float> mass;  // how much more a row counts for what the previous frame adds to it: 1..2

    void filter_row(int y);
    void add_own_row(RowSums& row, int y) const;
    void add_previous_row(RowSums& row, int y) const;
    void filter_column_row(int y);  // into now.channels, which the row pass has read
};

/// Pairs within the row: each weight serves both its pixels.
void Filter::add_own_row(RowSums& row, int y) const {
    const Span span = spans[std::size_t(y)];
    std::vector<const float*> left(now.channels.size()), right(now.channels.size());
    for (int i = 1; i <= kernel.radius && span.begin + i < span.end; ++i) {
        const int x = span.begin, count = span.end - i - x;
        weigh(pixel_run(now, now.precision_x, x, y), pixel_run(now, now.precision_x, x + i, y),
              count, kernel.normal_cosine, row.weights.data());
        point_to(now.channels, now.object.index(x, y), left);
        point_to(now.channels, now.object.index(x + i, y), right);
        add_pairs(row, x, count, left, right);
        add_pairs(row, x + i, count, right, left);
    }
}

void Filter::add_previous_row(RowSums& row, int y) const {
    const Span span = spans[std::size_t(y)];
    std::vector<const float*> own(now.channels.size()), other(now.channels.size());
    for (int i = -kernel.radius; i <= kernel.radius; ++i) {
        const int x = std::max(span.begin, span.begin - i);
        const int count = std::min(span.end, span.end - i) - x;
        if (count <= 0) continue;
        weigh(pixel_run(now, now.precision_x, x, y),
              pixel_run(*previous, previous->precision_x, x + i, y), count, kernel.normal_cosine,
              row.weights.data());
        point_to(now.channels, now.object.index(x, y), own);
        point_to(previous->channels, now.object.index(x + i, y), other);
        add_pairs(row, x, count, own, other);
    }
}

void Filter::filter_row(int y) {
    const Span span = spans[std::size_t(y)];
    if (span.begin >= span.end) return;
    RowSums row(now.object.width, now.channels.size());
    std::fill_n(row.of_weights(), row.width, 1.0f);  // the pixel itself
    add_own_row(row, y);
    if (previous != nullptr) {
        const std::vector<float> own(row.of_weights(), row.of_weights() + row.width);
        add_previous_row(row, y);
        for (int x = span.begin; x < span.end; ++x)
            mass(x, y) = row.of_weights()[x] / own[std::size_t(x)];
    }
    for (std::size_t c = 0; c < now.channels.size(); ++c) {
        for (int x = span.begin; x < span.end; ++x) {
            smoothed[c](x, y) = now.channels[c](x, y) + row.of_channel(c)[x] / row.of_weights()[x];
        }
    }
}

void Filter::filter_column_row(int y) {
    const Span span = spans[std::size_t(y)];
    if (span.begin >= span.end) return;
    RowSums row(now.object.width, now.channels.size());
    std::copy_n(&mass(0, y), row.width, row.of_weights());
    std::vector<const float*> own(now.channels.size()), other(now.channels.size());
    const int last = std::min(y + kernel.radius, now.object.height - 1);
    for (int v = std::max(y - kernel.radius, 0); v <= last; ++v) {
        const int x = std::max(span.begin, spans[std::size_t(v)].begin);
        const int count = std::min(span.end, spans[std::size_t(v)].end) - x;
        if (v == y || count <= 0) continue;
        weigh(pixel_run(now, now.precision_y, x, y), pixel_run(now, now.precision_y, x, v), count,
              kernel.normal_cosine, row.weights.data());
        for (int k = 0; k < count; ++k)
            row.weights[std::size_t(k)] *= mass(x + k, v);
        point_to(smoothed, now.object.index(x, y), own);
        point_to(smoothed, now.object.index(x, v), other);
        add_pairs(row, x, count, own, other);
    }
    for (std::size_t c = 0; c < now.channels.size(); ++c) {
        for (int x = span.begin; x < span.end; ++x)
            now.channels[c](x, y) = smoothed[c](x, y) + row.of_channel(c)[x] / row.of_weights()[x];
    }
}

}  // namespace

std::vector<Image<float>> filter_axis_aligned(FilterPlanes now, const FilterPlanes* previous,
                                              const KernelSettings& kernel) {
    if (now.channels.empty() || now.object.empty()) return std::move(now.channels);
    const int width = now.object.width, height = now.object.height;
    std::vector<Image<float>> blank(now.channels.size(), Image<float>(width, height, 0.0f));
    Filter filter{now,
                  previous,
                  kernel,
                  occupied_spans(now.object),
                  std::move(blank),
                  Image<float>(width, height, 1.0f)};
    parallel_rows(height, [&](int y) { filter.filter_row(y); });
    parallel_rows(height, [&](int y) { filter.filter_column_row(y); });
    return std::move(now.channels);
}

}  // namespace inlay
