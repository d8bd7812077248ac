// PriceFront: what error costs in time, by the number of samples, measured on one machine.
#pragma once

#include <vector>

namespace inlay {

struct PricePoint {
    int samples = 0;   // light samples per pixel, as of --samples
    double ms = 0;     // wall time that depends on them: tracing and filtering
    double error = 0;  // RMSE of linear radiance over the pixels that virtual objects influence
};

/// Ascending samples, ascending times, descending errors.
struct PriceFront {
    std::vector<PricePoint> points;
    double other_ms = 0;  // of a frame, whatever the samples: loading, tracking, writing, ...
};

/// The points of `measured` that no other one beats in time and in error at once.
std::vector<PricePoint> pareto(std::vector<PricePoint> measured);

/// Time at any number of samples (> 0): on straight lines through the points, and on the outer ones
/// beyond them; fewer samples than measured cost no less than in proportion. The front must have a
/// point.
double ms_at(const PriceFront& front, int samples);

/// Error at any number of samples (> 0): straight lines in the logarithms of both, and the outer
/// ones beyond them, with a slope from -1/2 to -1/10. A single point is continued with the inverse
/// fourth root of the samples, as the filter narrows its widths (see sample_factor). The front must
/// have a point.
double error_at(const PriceFront& front, int samples);

/// The numbers of samples that `--samples` takes, up to 1024.
std::vector<int> sample_ladder();

}  // namespace inlay
