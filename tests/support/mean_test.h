// Does a mean agree with a closed form? p-values for means, and their share of the significance.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace inlay::test {

/// Mean and variance of a growing sample (Welford 1962).
struct RunningMean {
    int count = 0;
    double mean = 0, squares = 0;  // squares: sum of squared distances from the mean

    void add(double x) {
        const double before = x - mean;
        mean += before / ++count;
        squares += before * (x - mean);
    }
    double variance() const { return count > 1 ? squares / (count - 1) : 0; }
    double standard_error() const { return count > 0 ? std::sqrt(variance() / count) : 0; }
};

inline RunningMean mean_of(std::span<const double> values) {
    RunningMean result;
    for (const double x : values)
        result.add(x);
    return result;
}

/// Two-sided p-value of a standard normal deviate.
inline double normal_p_value(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

/// I_x(a, b), the regularised incomplete beta function: Lentz's evaluation of its continued
/// fraction, which converges fast for x < (a + 1) / (a + b + 2).
inline double regularised_beta(double x, double a, double b) {
    if (!(x > 0)) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - regularised_beta(1 - x, b, a);
    const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                  a * std::log(x) + b * std::log1p(-x)) /
                         a;
    const auto nonzero = [](double v) { return std::abs(v) < 1e-300 ? 1e-300 : v; };
    double c = 1, d = 1 / nonzero(1 - (a + b) * x / (a + 1)), fraction = d;
    for (int m = 1; m < 500; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / nonzero(1 + even * d);
        c = nonzero(1 + even / c);
        fraction *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / nonzero(1 + odd * d);
        c = nonzero(1 + odd / c);
        const double step = d * c;
        fraction *= step;
        if (std::abs(step - 1) < 1e-14) break;
    }
    return front * fraction;
}

/// Two-sided p-value of Student's t: that values of mean `reference` have a mean as far off as
/// this one. Values without any spread must equal the reference up to float rounding.
inline double mean_p_value(const RunningMean& m, double reference) {
    if (m.count < 2 || !std::isfinite(m.mean)) return 0;
    const double off = std::abs(m.mean - reference);
    if (off <= 1e-6 * std::abs(reference)) return 1;
    if (!(m.variance() > 0)) return 0;
    const double t = off / m.standard_error(), freedom = m.count - 1;
    return regularised_beta(freedom / (freedom + t * t), freedom / 2, 0.5);
}

/// Significance for each of `tests`, so that all of them together err with probability `overall`.
inline double sidak(double overall, int tests) { return -std::expm1(std::log1p(-overall) / tests); }

/// How many p-values one test program may ask for; `plausible` fails beyond it, because each
/// comparison was promised its share of the program's significance of 0.01.
inline constexpr int p_values_per_program = 400;

/// Whether a p-value passes at this program's significance.
inline ::testing::AssertionResult plausible(double p) {
    static int asked = 0;
    if (++asked > p_values_per_program) {
        return ::testing::AssertionFailure()
               << "more p-values than the significance was shared out for: "
                  "raise p_values_per_program";
    }
    const double limit = sidak(0.01, p_values_per_program);
    if (p >= limit) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "p = " << p << ", rejected below " << limit;
}

/// Whether values with this mean are plausible if their expectation is `reference`.
inline ::testing::AssertionResult has_mean(const RunningMean& m, double reference) {
    return plausible(mean_p_value(m, reference))
           << "; mean " << m.mean << " +- " << m.standard_error() << " of " << m.count
           << " values, expected " << reference;
}

}  // namespace inlay::test
