#include "composite/govern/price_front.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr double least_error = 1e-12;  // whose logarithm is finite
constexpr double lone_slope = -0.25;   // of log error over log samples, with one point alone
constexpr int most_samples = 1024;

/// The two neighbors whose line holds `samples`.
struct Segment {
    PricePoint a, b;
};

Segment segment_at(const std::vector<PricePoint>& points, int samples) {
    std::size_t i = 1;
    while (i + 1 < points.size() && points[i].samples < samples)
        ++i;
    return {points[i - 1], points[i]};
}

/// Beyond the points a line between two of them, which are noisy, is no law: errors fall with the
/// square root of the samples at best, and in the end hardly.
constexpr double steepest = -0.5, flattest = -0.1;

double on_line(double x0, double y0, double x1, double y1, double x) {
    return y0 + (y1 - y0) * (x - x0) / (x1 - x0);
}

}  // namespace

std::vector<PricePoint> pareto(std::vector<PricePoint> measured) {
    std::sort(measured.begin(), measured.end(), [](const PricePoint& a, const PricePoint& b) {
        return a.ms != b.ms ? a.ms < b.ms : a.error < b.error;
    });
    std::vector<PricePoint> front;
    for (const PricePoint& p : measured)
        if (front.empty() || (p.error < front.back().error && p.samples > front.back().samples &&
                              p.ms > front.back().ms))
            front.push_back(p);
    return front;
}

double ms_at(const PriceFront& front, int samples) {
    require(!front.points.empty(), "a price front has no point");
    if (front.points.size() == 1)
        return front.points[0].ms * samples / std::max(1, front.points[0].samples);
    const auto [a, b] = segment_at(front.points, samples);
    const double proportional = a.ms * std::min(1.0, double(samples) / a.samples);
    return std::max(proportional, on_line(a.samples, a.ms, b.samples, b.ms, samples));
}

double error_at(const PriceFront& front, int samples) {
    require(!front.points.empty(), "a price front has no point");
    const auto log_error = [](const PricePoint& p) {
        return std::log(std::max(p.error, least_error));
    };
    const double x = std::log(double(samples));
    if (front.points.size() == 1) {
        const PricePoint& p = front.points[0];
        return std::exp(log_error(p) + lone_slope * (x - std::log(double(p.samples))));
    }
    const auto [a, b] = segment_at(front.points, samples);
    const double x_a = std::log(double(a.samples)), x_b = std::log(double(b.samples));
    if (samples >= a.samples && samples <= b.samples)
        return std::exp(on_line(x_a, log_error(a), x_b, log_error(b), x));
    const double slope =
        std::clamp((log_error(b) - log_error(a)) / (x_b - x_a), steepest, flattest);
    const bool before = samples < a.samples;
    return std::exp(log_error(before ? a : b) + slope * (x - (before ? x_a : x_b)));
}

std::vector<int> sample_ladder() {
    std::vector<int> ladder{1, 2, 3};
    for (int samples = 4; samples <= most_samples; samples += 4)
        ladder.push_back(samples);
    return ladder;
}

}  // namespace inlay
