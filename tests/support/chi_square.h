// Does a sampler follow its density? Pearson's chi-square over a grid of directions.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <vector>

namespace inlay::test {

/// Q(a, x) = Gamma(a, x) / Gamma(a): the series below a + 1, Lentz's continued fraction above.
inline double regularised_upper_gamma(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > 1e-16 * sum; ++n)
            sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
    for (int n = 1; n < 10000; ++n) {
        const double numerator = n * (a - n);
        b += 2;
        d = 1 / (b + numerator * d);
        c = b + numerator / c;
        fraction *= d * c;
        if (std::abs(d * c - 1) < 1e-14) break;
    }
    return front * fraction;
}

/// p-value of counts under their expectations. Cells expected to hold fewer than 5 are pooled; a
/// count where nothing at all is expected is impossible, p = 0.
inline double chi_square_p_value(const std::vector<double>& counts,
                                 const std::vector<double>& expected) {
    double statistic = 0, pooled_count = 0, pooled_expected = 0;
    int cells = 0;
    const auto add = [&](double count, double expectation) {
        statistic += (count - expectation) * (count - expectation) / expectation;
        ++cells;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] < 5) {
            pooled_count += counts[i];
            pooled_expected += expected[i];
        } else {
            add(counts[i], expected[i]);
        }
    }
    if (pooled_expected > 1e-3) {
        add(pooled_count, pooled_expected);
    } else if (pooled_count > 0) {
        return 0;
    }
    return cells > 1 ? regularised_upper_gamma(0.5 * (cells - 1), 0.5 * statistic) : 0;
}

/// Cells equal in the cosine to +z and in the azimuth, from cosine 1 down to `lowest_cosine`.
struct DirectionGrid {
    int cosines = 16, azimuths = 32;
    double lowest_cosine = -1;

    std::size_t size() const { return std::size_t(cosines * azimuths); }

    /// The cell of a unit direction; size() below the grid.
    std::size_t cell(const glm::dvec3& d) const {
        const double row = (1 - d.z) / (1 - lowest_cosine) * cosines;
        if (row >= cosines) return size();
        const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 1;
        const int column = int((turn - std::floor(turn)) * azimuths) % azimuths;
        return std::size_t(std::max(0, int(row)) * azimuths + column);
    }

    /// Integral of a density over a cell: midpoint rules, refined until they settle.
    double integral(std::size_t cell,
                    const std::function<double(const glm::dvec3&)>& density) const {
        double coarse = midpoint_rule(cell, density, 4);
        for (int steps = 8; steps <= 512; steps *= 2) {
            const double fine = midpoint_rule(cell, density, steps);
            // Far below what 1e5 samples can tell
            if (std::abs(fine - coarse) <= 3e-4 * fine + 1e-8) return fine;
            coarse = fine;
        }
        return coarse;
    }

    double midpoint_rule(std::size_t cell, const std::function<double(const glm::dvec3&)>& density,
                         int steps) const {
        const double d_cosine = (1 - lowest_cosine) / cosines / steps;
        const double d_azimuth = 2 * std::numbers::pi / azimuths / steps;
        const int row = int(cell) / azimuths, column = int(cell) % azimuths;
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            const double z = 1 - (row * steps + i + 0.5) * d_cosine;
            const double r = std::sqrt(std::max(0.0, 1 - z * z));
            for (int j = 0; j < steps; ++j) {
                const double azimuth = (column * steps + j + 0.5) * d_azimuth;
                sum += density({r * std::cos(azimuth), r * std::sin(azimuth), z});
            }
        }
        return sum * d_cosine * d_azimuth;
    }
};

/// p-value that `sample` follows `density` (per steradian). `sample(i)` returns the i-th direction,
/// or the zero vector where it gave none: those and the directions below the grid form a cell of
/// their own, which holds what the density leaves over.
inline double sampling_p_value(const DirectionGrid& grid, int samples,
                               const std::function<glm::dvec3(int)>& sample,
                               const std::function<double(const glm::dvec3&)>& density) {
    std::vector<double> counts(grid.size() + 1, 0.0), expected(grid.size() + 1, 0.0);
    for (int i = 0; i < samples; ++i) {
        const glm::dvec3 d = sample(i);
        counts[glm::dot(d, d) > 0 ? grid.cell(d) : grid.size()] += 1;
    }
    for (std::size_t cell = 0; cell < grid.size(); ++cell)
        expected[cell] = samples * grid.integral(cell, density);
    const double inside = std::accumulate(expected.begin(), expected.end(), 0.0);
    // Quadrature leaves up to 1e-4 of a density that fills the grid: less than one such count.
    expected.back() = std::max(0.0, samples - inside);
    if (expected.back() < 1e-4 * samples && counts.back() == 0) expected.back() = 0;
    return chi_square_p_value(counts, expected);
}

/// The density (per steradian) that a smooth warp of the unit square has at `u`, without
/// statistics: 1 / |d omega / d u|, by central differences of `step`.
inline double density_from_jacobian(const std::function<glm::dvec3(glm::vec2)>& warp, glm::vec2 u,
                                    float step) {
    const auto along = [&](glm::vec2 offset) {
        return (warp(u + offset) - warp(u - offset)) / double(2 * step);
    };
    return 1 / glm::length(glm::cross(along({step, 0}), along({0, step})));
}

}  // namespace inlay::test
