// Band powers by a Fourier sum along each row and a Legendre recurrence across rows.
#include "render/filter/environment_bandwidth.h"

#include "recordings/base/environment_map.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace inlay {
namespace {

using std::numbers::pi;

constexpr int most_rows = 256;
constexpr int fewest_rows = 128;  // two per period of the highest degree
constexpr double negligible = 1e-6;

/// Luminance on a grid fine enough for the quadrature, row-major.
struct Grid {
    int width = 0, height = 0;
    std::vector<double> value;
};

/// The share of a source cell's measure that each of `target` equal intervals takes.
struct Overlap {
    int source;
    double weight;
};

/// For each of `target` equal intervals of 0..1: which of `source` intervals it overlaps, and by
/// how much of `measure` (an increasing function); weights of one target sum to 1.
template <class Measure>
std::vector<std::vector<Overlap>> overlaps(int source, int target, const Measure& measure) {
    std::vector<std::vector<Overlap>> result(std::size_t(target), std::vector<Overlap>{});
    for (int t = 0; t < target; ++t) {
        const double begin = double(t) / target, end = double(t + 1) / target;
        const double all = measure(end) - measure(begin);
        const int last = std::min(source - 1, int(std::ceil(end * source - 1e-9)) - 1);
        for (int s = int(begin * source + 1e-9); s <= last; ++s) {
            const double from = std::max(begin, double(s) / source);
            const double to = std::min(end, double(s + 1) / source);
            result[std::size_t(t)].push_back({s, (measure(to) - measure(from)) / all});
        }
    }
    return result;
}

double finite_luminance(const Rgb& c) {
    const double l = luminance(c);
    return std::isfinite(l) ? l : 0.0;
}

/// The map's luminance with texels split or averaged so that the rows are 128 to 256.
Grid quadrature_grid(const Image<Rgb>& map) {
    const auto fitted = [](int n, int fewest, int most) {
        return n > most ? most : n * ((fewest + n - 1) / n);
    };
    Grid grid;
    grid.height = fitted(map.height, fewest_rows, most_rows);
    grid.width = fitted(map.width, 2 * fewest_rows, 2 * most_rows);
    grid.value.assign(std::size_t(grid.width) * std::size_t(grid.height), 0.0);
    const auto columns = overlaps(map.width, grid.width, [](double u) { return u; });
    const auto rows = overlaps(map.height, grid.height, [](double v) { return -std::cos(pi * v); });
    parallel_rows(grid.height, [&](int y) {
        double* out = &grid.value[std::size_t(y) * std::size_t(grid.width)];
        for (const Overlap& r : rows[std::size_t(y)]) {
            const auto source = map.row(r.source);
            for (int x = 0; x < grid.width; ++x) {
                for (const Overlap& c : columns[std::size_t(x)])
                    out[x] += r.weight * c.weight * finite_luminance(source[std::size_t(c.source)]);
            }
        }
    });
    return grid;
}

double row_solid_angle(const Grid& grid, int y) {
    return 2 * pi * (std::cos(pi * y / grid.height) - std::cos(pi * (y + 1) / grid.height));
}

/// The mean over the sphere.
double mean_of(const Grid& grid) {
    double sum = 0;
    for (int y = 0; y < grid.height; ++y) {
        const double each = row_solid_angle(grid, y) / grid.width;
        for (int x = 0; x < grid.width; ++x)
            sum += each * grid.value[std::size_t(y) * std::size_t(grid.width) + std::size_t(x)];
    }
    return sum / (4 * pi);
}

using Row = std::vector<std::complex<double>>;

/// For each row, the Fourier coefficients of (value - mean) along longitude, times the row's share
/// of solid angle.
std::vector<Row> row_spectra(const Grid& grid, double mean) {
    std::vector<std::complex<double>> turn(std::size_t(grid.width), 0.0);
    for (int x = 0; x < grid.width; ++x)
        turn[std::size_t(x)] = std::polar(1.0, -2 * pi * x / grid.width);
    std::vector<Row> spectra(std::size_t(grid.height), Row(environment_degrees));
    parallel_rows(grid.height, [&](int y) {
        const double* row = &grid.value[std::size_t(y) * std::size_t(grid.width)];
        const double each = row_solid_angle(grid, y) / grid.width;
        for (int m = 0; m < environment_degrees; ++m) {
            std::complex<double> sum = 0;
            for (int x = 0; x < grid.width; ++x)
                sum += (row[x] - mean) * turn[std::size_t(m) * std::size_t(x) % turn.size()];
            spectra[std::size_t(y)][std::size_t(m)] = each * sum;
        }
    });
    return spectra;
}

/// |L_lm|^2 for l = m .. 63, both signs of m together, by the recurrence of the normalised
/// associated Legendre functions in l.
std::vector<double> powers_of_order(const std::vector<Row>& spectra, int m) {
    std::vector<std::complex<double>> coefficient(environment_degrees, 0.0);
    const int height = int(spectra.size());
    for (int y = 0; y < height; ++y) {
        const double polar = pi * (y + 0.5) / height;
        const double x = std::cos(polar), s = std::sin(polar);
        double diagonal = std::sqrt(1 / (4 * pi));
        for (int k = 1; k <= m; ++k)
            diagonal *= s * std::sqrt((2 * k + 1) / (2.0 * k));
        double before = 0, p = diagonal, previous_a = 0;
        for (int l = m; l < environment_degrees; ++l) {
            if (l > m) {
                const double a = std::sqrt((4.0 * l * l - 1) / (double(l) * l - double(m) * m));
                const double next = a * x * p - (l > m + 1 ? a / previous_a * before : 0.0);
                before = p, p = next, previous_a = a;
            }
            coefficient[std::size_t(l)] += p * spectra[std::size_t(y)][std::size_t(m)];
        }
    }
    std::vector<double> powers(environment_degrees, 0.0);
    for (int l = m; l < environment_degrees; ++l)
        powers[std::size_t(l)] = (m == 0 ? 1 : 2) * std::norm(coefficient[std::size_t(l)]);
    return powers;
}

}  // namespace

std::vector<double> spherical_harmonic_powers(const Image<Rgb>& radiance) {
    std::vector<double> powers(environment_degrees, 0.0);
    if (radiance.empty()) return powers;
    const Grid grid = quadrature_grid(radiance);
    const double mean = mean_of(grid);
    const std::vector<Row> spectra = row_spectra(grid, mean);
    std::vector<std::vector<double>> of_order(environment_degrees, std::vector<double>{});
    parallel_for(environment_degrees,
                 [&](int m) { of_order[std::size_t(m)] = powers_of_order(spectra, m); });
    for (const std::vector<double>& order : of_order) {
        for (std::size_t l = 1; l < powers.size(); ++l)
            powers[l] += order[l];
    }
    powers[0] = 4 * pi * mean * mean;
    return powers;
}

double environment_bandwidth(const Image<Rgb>& radiance, double energy) {
    const std::vector<double> powers = spherical_harmonic_powers(radiance);
    double all = 0;
    for (std::size_t l = 1; l < powers.size(); ++l)
        all += powers[l];
    if (!(all > negligible * powers[0])) return 0;
    double held = 0;
    std::size_t l = 0;
    while (l + 1 < powers.size() && held < energy * all)
        held += powers[++l];
    return double(l);
}

}  // namespace inlay
