#include "slam/registration/solve_mapping.h"

#include "recordings/base/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace inlay {
namespace {

using Index = MappingParameter;
using Matrix9 = Eigen::Matrix<double, int(Index::count), int(Index::count)>;
using Vector9 = Eigen::Matrix<double, int(Index::count), 1>;

/// Neighbours on a rim err alike: so many of them know as much as one.
constexpr double alike = 20;
constexpr double damping = 1e-3;     // of the diagonal
constexpr double distance_cap = 10;  // px, of EdgeDistances
constexpr double near_distance = 2;  // px, likewise

/// What is expected of two cameras in one housing, standard deviations: 3 degrees, 30 mm along the
/// row of cameras and 10 mm across it, 50 ms, a tenth of the focal length, 1 px.
constexpr MappingStep expected{0.05, 0.05, 0.05, 0.03, 0.01, 0.01, 0.05, 0.1, 1.0};

/// Steps below these end a solve.
constexpr MappingStep still{2e-5, 2e-5, 2e-5, 2e-5, 2e-5, 2e-5, 2e-5, 2e-5, 2e-3};

/// Sums over points, of which each frame makes its own.
struct Sum {
    double value = 0;
    double near = 0;
    int points = 0;
    Sum& operator+=(const Sum& other) {
        value += other.value;
        near += other.near;
        points += other.points;
        return *this;
    }
    double mean() const { return value / std::max(points, 1); }
};

struct Equations {
    Matrix9 a = Matrix9::Zero();
    Vector9 b = Vector9::Zero();
    Sum cost;
    Equations& operator+=(const Equations& other) {
        a += other.a;
        b += other.b;
        cost += other.cost;
        return *this;
    }
};

std::vector<int> all_of(const RimViews& problem) {
    std::vector<int> all(problem.views.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// term(view, its mapping) of the chosen frames, added in order.
template <class Term>
auto total(const RimViews& problem, std::span<const int> chosen, const ColorMapping& mapping,
           const Term& term) {
    using Value = decltype(term(problem.views.front(), FrameMapping{}));
    std::vector<Value> terms(chosen.size());
    parallel_for(int(chosen.size()), [&](int i) {
        const RimView& view = problem.views[std::size_t(chosen[std::size_t(i)])];
        terms[std::size_t(i)] =
            term(view, mapping_at(mapping, problem.color_lens, problem.trajectory, view.time));
    });
    Value sum;
    for (const Value& value : terms)
        sum += value;
    return sum;
}

double bell(double distance, double sigma) {
    return std::exp(-0.5 * distance * distance / (sigma * sigma));
}

Equations equations_of(const RimView& view, const FrameMapping& mapping,
                       const EdgeMatching& matching) {
    Equations result;
    for (const RimPoint& point : view.points) {
        const SeenRim seen = see(mapping, point);
        const std::optional<EdgeMatch> match = match_edge(view.edges, seen, matching);
        if (!match) continue;
        const double weight = bell(match->distance, matching.sigma);
        const MappingStep row = derivative(mapping, point, seen, match->direction);
        const Eigen::Map<const Vector9> j(row.data());
        result.a.noalias() += weight * j * j.transpose();
        result.b.noalias() -= weight * match->distance * j;
        result.cost.value += 1 - weight;
        ++result.cost.points;
    }
    return result;
}

std::array<bool, Index::count> free_parameters(const MappingFreedom& free) {
    const bool t = free.translation;
    return {true, true, true, t, t, t, free.delay, free.log_focal, free.rim};
}

MappingStep step_of(const Equations& equations, const ColorMapping& mapping,
                    const MappingFreedom& freedom) {
    const std::array<bool, Index::count> free = free_parameters(freedom);
    const MappingStep value = parameters_of(mapping);
    Matrix9 a = equations.a / alike;
    Vector9 b = equations.b / alike;
    for (std::size_t k = 0; k < Index::count; ++k) {
        const auto i = Eigen::Index(k);
        const double information = 1 / (expected[k] * expected[k]);
        a(i, i) = (a(i, i) + information) * (1 + damping);
        b(i) -= value[k] * information;
        if (free[k]) continue;
        a.row(i).setZero();
        a.col(i).setZero();
        a(i, i) = 1;
        b(i) = 0;
    }
    MappingStep step;
    Eigen::Map<Vector9>(step.data()) = a.ldlt().solve(b);
    return step;
}

bool is_still(const MappingStep& step) {
    for (std::size_t k = 0; k < Index::count; ++k)
        if (std::abs(step[k]) >= still[k]) return false;
    return true;
}

}  // namespace

SolvedMapping solve_mapping(const RimViews& problem, std::span<const int> chosen,
                            const ColorMapping& start, const SolveStage& stage) {
    SolvedMapping solved{start};
    for (int i = 0; i < stage.iterations; ++i) {
        const Equations equations = total(problem, chosen, solved.mapping,
                                          [&](const RimView& view, const FrameMapping& mapping) {
                                              return equations_of(view, mapping, stage.matching);
                                          });
        if (equations.cost.points == 0) break;
        const MappingStep step = step_of(equations, solved.mapping, stage.free);
        solved.mapping = moved(solved.mapping, step);
        solved.cost = equations.cost.mean();
        if (is_still(step)) break;
    }
    return solved;
}

double mapping_score(const RimViews& problem, std::span<const int> chosen,
                     const ColorMapping& mapping, double sigma) {
    const EdgeMatching matching{EdgeChoice::nearest, sigma};
    const auto score = [&](const RimView& view, const FrameMapping& frame) {
        Sum sum;
        for (const RimPoint& point : view.points) {
            const auto match = match_edge(view.edges, see(frame, point), matching);
            if (!match) continue;
            sum.value += bell(match->distance, sigma);
            ++sum.points;
        }
        return sum;
    };
    return total(problem, chosen, mapping, score).mean();
}

double mapping_shift(const RimViews& problem, ColorMapping a, ColorMapping b) {
    a.rim = b.rim = 0;
    const auto shift = [&](const RimView& view, const FrameMapping& from_a) {
        const FrameMapping from_b =
            mapping_at(b, problem.color_lens, problem.trajectory, view.time);
        Sum sum;
        for (const RimPoint& point : view.points) {
            const SeenRim in_a = see(from_a, point), in_b = see(from_b, point);
            if (!in_a.ahead || !in_b.ahead) continue;
            const glm::dvec2 apart = in_a.position - in_b.position;
            sum.value += glm::dot(apart, apart);
            ++sum.points;
        }
        return sum;
    };
    return std::sqrt(total(problem, all_of(problem), a, shift).mean());
}

EdgeDistances edge_distances(const RimViews& problem, const ColorMapping& mapping) {
    const auto distances = [&](const RimView& view, const FrameMapping& frame) {
        Sum sum;
        for (const RimPoint& point : view.points) {
            const auto match = match_edge(view.edges, see(frame, point), {});
            if (!match) continue;
            sum.value += std::min(match->distance, distance_cap);
            sum.near += match->distance < near_distance ? 1 : 0;
            ++sum.points;
        }
        return sum;
    };
    const Sum sum = total(problem, all_of(problem), mapping, distances);
    return {sum.mean(), sum.near / std::max(sum.points, 1)};
}

}  // namespace inlay
