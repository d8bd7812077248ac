#include "composite/accuracy/price_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace inlay {
namespace {

/// The method whose price the others are compared with, and the setting at which they are.
constexpr const char* anchor_knob = "samples";
constexpr const char* anchor_value = "16";

bool is_priced(const Cell& cell) {
    return cell.failed.empty() && cell.converged && cell.converged->rmse_influenced;
}

PricedPoint point_of(const Cell& cell, double error) {
    return {cell.wall.total.median, error, cell.converged->flip, cell.primary * cell.secondary,
            cell.id};
}

PricedPoint rmse_point(const Cell& cell) {
    return point_of(cell, *cell.converged->rmse_influenced);
}

std::vector<std::string> ids_of(const std::vector<PricedPoint>& front) {
    std::vector<std::string> ids;
    for (const PricedPoint& point : front)
        ids.push_back(point.id);
    return ids;
}

std::vector<PricedPoint> front_of(const std::vector<Cell>& cells, const std::string& method,
                                  bool temporal) {
    std::vector<PricedPoint> points;
    for (const Cell& cell : cells)
        if (is_priced(cell) && cell.method == method && cell.temporal == temporal)
            points.push_back(rmse_point(cell));
    return pareto_front(std::move(points));
}

bool is_anchor(const Cell& cell) {
    return is_priced(cell) && cell.knob == anchor_knob && cell.value == anchor_value;
}

double log_mix(double a, double b, double t) {
    if (a <= 0 || b <= 0) return a + t * (b - a);
    return std::exp(std::log(a) + t * (std::log(b) - std::log(a)));
}

FrontPlace between(const PricedPoint& a, const PricedPoint& b, double t) {
    return {log_mix(a.ms, b.ms, t), log_mix(a.error, b.error, t), log_mix(a.flip, b.flip, t),
            log_mix(a.samples, b.samples, t), false};
}

FrontPlace at(const PricedPoint& point, bool beyond) {
    return {point.ms, point.error, point.flip, double(point.samples), beyond};
}

/// Share of the way from a to b, in logarithms, at which x lies.
double log_share(double a, double b, double x) {
    if (a == b) return 0;
    if (a <= 0 || b <= 0 || x <= 0) return (x - a) / (b - a);
    return (std::log(x) - std::log(a)) / (std::log(b) - std::log(a));
}

double ratio(double a, double b) { return b > 0 ? a / b : (a > 0 ? INFINITY : 1.0); }

void add_equal_error(const Cell& anchor, const std::vector<PricedPoint>& unfiltered,
                     PriceList& list) {
    const PricedPoint point = rmse_point(anchor);
    const auto place = at_error(unfiltered, point.error);
    if (!place) return;
    list.equal_error.push_back({anchor.method, anchor.id, anchor.temporal, point.error, place->ms,
                                point.ms, ratio(place->ms, point.ms), place->samples,
                                ratio(point.flip, place->flip), place->beyond});
}

void add_equal_time(const Cell& anchor, const std::vector<Cell>& cells, PriceList& list) {
    const PricedPoint point = rmse_point(anchor);
    std::vector<std::string> seen;
    for (const Cell& cell : cells) {
        const bool never_temporal = cell.method == "unfiltered";
        if (std::find(seen.begin(), seen.end(), cell.method) != seen.end()) continue;
        if (cell.temporal != anchor.temporal && !never_temporal) continue;
        seen.push_back(cell.method);
        const auto place = at_time(front_of(cells, cell.method, cell.temporal), point.ms);
        if (!place) continue;
        list.equal_time.push_back({cell.method, anchor.temporal, place->ms, place->error,
                                   place->flip, ratio(place->error, point.error),
                                   ratio(place->flip, point.flip), place->beyond});
    }
}

}  // namespace

std::vector<PricedPoint> pareto_front(std::vector<PricedPoint> points) {
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return std::pair(a.ms, a.error) < std::pair(b.ms, b.error);
    });
    std::vector<PricedPoint> front;
    for (PricedPoint& point : points)
        if (front.empty() || point.error < front.back().error) front.push_back(std::move(point));
    return front;
}

std::optional<FrontPlace> at_error(const std::vector<PricedPoint>& front, double error) {
    if (front.empty()) return std::nullopt;
    if (front.front().error <= error) return at(front.front(), false);
    for (std::size_t i = 1; i < front.size(); ++i) {
        if (front[i].error > error) continue;
        return between(front[i - 1], front[i],
                       log_share(front[i - 1].error, front[i].error, error));
    }
    return at(front.back(), true);
}

std::optional<FrontPlace> at_time(const std::vector<PricedPoint>& front, double ms) {
    if (front.empty() || front.front().ms > ms) return std::nullopt;
    for (std::size_t i = 1; i < front.size(); ++i) {
        if (front[i].ms < ms) continue;
        return between(front[i - 1], front[i], log_share(front[i - 1].ms, front[i].ms, ms));
    }
    return at(front.back(), front.back().ms < ms);
}

PriceList price_list(const std::vector<Cell>& cells) {
    PriceList list;
    std::vector<PricedPoint> by_rmse, by_flip;
    for (const Cell& cell : cells) {
        if (!is_priced(cell)) continue;
        by_rmse.push_back(rmse_point(cell));
        by_flip.push_back(point_of(cell, cell.converged->flip));
    }
    list.rmse_front = ids_of(pareto_front(std::move(by_rmse)));
    list.flip_front = ids_of(pareto_front(std::move(by_flip)));
    const std::vector<PricedPoint> unfiltered = front_of(cells, "unfiltered", false);
    for (const Cell& cell : cells) {
        if (!is_anchor(cell)) continue;
        if (cell.method != "unfiltered") add_equal_error(cell, unfiltered, list);
        if (cell.method == default_method) add_equal_time(cell, cells, list);
    }
    return list;
}

}  // namespace inlay
