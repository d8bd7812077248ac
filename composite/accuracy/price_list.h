// Price list: what follows from the cells of a work: Pareto fronts, and methods compared at equal
// error and at equal time.
#pragma once

#include "composite/accuracy/cell.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// A cell as a point of error against time.
struct PricedPoint {
    double ms = 0;     // trace + filter + composite, wall, median
    double error = 0;  // of the figure that is compared
    double flip = 0;
    int samples = 0;
    std::string id;
};

/// The points that no other one beats in both, cheapest first: errors fall strictly.
std::vector<PricedPoint> pareto_front(std::vector<PricedPoint> points);

/// A place on a front, interpolated linearly in the logarithms of time and error. `beyond`: the
/// front ends before it, and its last point stands as a bound.
struct FrontPlace {
    double ms = 0, error = 0, flip = 0, samples = 0;
    bool beyond = false;
};

/// Where a front (cheapest first) reaches `error`; its first point where that is good enough.
/// Nothing for an empty front.
std::optional<FrontPlace> at_error(const std::vector<PricedPoint>& front, double error);

/// What a front offers for `ms`; nothing where even its first point takes longer. `beyond` where
/// its last point takes less.
std::optional<FrontPlace> at_time(const std::vector<PricedPoint>& front, double ms);

/// Filtered at 16 samples against what unfiltered sampling takes to get as close.
struct EqualError {
    std::string method, anchor;
    bool temporal = false;
    double error = 0, unfiltered_ms = 0, filtered_ms = 0, speed_up = 0, unfiltered_samples = 0;
    double flip_ratio = 0;  // the anchor's FLIP over that of unfiltered there; < 1: it looks closer
    bool beyond = false;    // unfiltered takes longer than was measured: a lower bound
};

/// Every method at the time of the default filter with 16 samples.
struct EqualTime {
    std::string method;
    bool temporal = false;
    double ms = 0, rmse = 0, flip = 0;
    double rmse_ratio = 0, flip_ratio = 0;  // over the anchor's; > 1: the anchor is better
    bool beyond = false;                    // the method was not measured at so long a time
};

struct PriceList {
    std::vector<std::string> rmse_front, flip_front;  // cell ids, cheapest first
    std::vector<EqualError> equal_error;
    std::vector<EqualTime> equal_time;
};

/// Compares over the influenced pixels against `converged`. Cells that failed, that were measured
/// against truth alone or that have no influenced pixel take no part.
PriceList price_list(const std::vector<Cell>& cells);

}  // namespace inlay
