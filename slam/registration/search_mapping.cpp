#include "slam/registration/search_mapping.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace inlay {
namespace {

constexpr std::size_t coarse_frames = 8;
constexpr double grid_sigma = 8;        // px
constexpr std::size_t grid_starts = 4;  // best points of the grid that are solved from
constexpr std::array log_focals{-0.2, -0.1, 0.0, 0.1};
constexpr std::array turns{-0.03, 0.0, 0.03};      // rad, about x and about y
constexpr std::array baselines{-0.03, 0.0, 0.03};  // m, along x
constexpr int coarse_iterations = 8;
constexpr int fine_iterations = 10;
constexpr std::array<EdgeMatching, 3> fine_stages{EdgeMatching{EdgeChoice::nearest, 5},
                                                  EdgeMatching{EdgeChoice::crossed, 3},
                                                  EdgeMatching{EdgeChoice::crossed, 2}};
constexpr std::size_t frames_for_quarters = 12;

std::vector<int> some_frames(const RimViews& problem) {
    const std::size_t step = std::max<std::size_t>(1, problem.views.size() / coarse_frames);
    std::vector<int> some;
    for (std::size_t i = 0; i < problem.views.size(); i += step)
        some.push_back(int(i));
    return some;
}

std::vector<ColorMapping> grid(bool with_focal) {
    std::vector<ColorMapping> mappings;
    for (const double log_focal : log_focals) {
        if (!with_focal && log_focal != 0) continue;
        ColorMapping start;
        start.log_focal = log_focal;
        for (const double baseline : baselines) {
            for (const double about_x : turns) {
                for (const double about_y : turns)
                    mappings.push_back(moved(start, {about_x, about_y, 0, baseline}));
            }
        }
    }
    return mappings;
}

/// "Registered already", and the points of the grid with the highest scores.
std::vector<ColorMapping> starts_of(const RimViews& problem, std::span<const int> chosen,
                                    bool with_focal) {
    const std::vector<ColorMapping> mappings = grid(with_focal);
    std::vector<double> scores(mappings.size());
    parallel_for(int(mappings.size()), [&](int i) {
        scores[std::size_t(i)] =
            mapping_score(problem, chosen, mappings[std::size_t(i)], grid_sigma);
    });
    std::vector<std::size_t> order(mappings.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    std::vector<ColorMapping> starts{{}};
    for (std::size_t i = 0; i < grid_starts; ++i)
        starts.push_back(mappings[order[i]]);
    return starts;
}

SolvedMapping solve_coarsely(const RimViews& problem, std::span<const int> chosen,
                             const ColorMapping& start, const MappingUnknowns& unknowns) {
    const bool focal = unknowns.log_focal;
    const std::array<SolveStage, 3> stages{
        SolveStage{{EdgeChoice::nearest, 12}, {false, false, focal, false}, coarse_iterations},
        SolveStage{{EdgeChoice::nearest, 8}, {true, false, focal, false}, coarse_iterations},
        SolveStage{
            {EdgeChoice::nearest, 5}, {true, unknowns.delay, focal, false}, coarse_iterations}};
    SolvedMapping solved{start};
    for (const SolveStage& stage : stages)
        solved = solve_mapping(problem, chosen, solved.mapping, stage);
    return solved;
}

}  // namespace

ColorMapping search_mapping(const RimViews& problem, const MappingUnknowns& unknowns) {
    const std::vector<int> chosen = some_frames(problem);
    SolvedMapping best;
    for (const ColorMapping& start : starts_of(problem, chosen, unknowns.log_focal)) {
        const SolvedMapping solved = solve_coarsely(problem, chosen, start, unknowns);
        if (solved.cost < best.cost) best = solved;
    }
    return best.mapping;
}

ColorMapping refine_mapping(const RimViews& problem, std::span<const int> chosen,
                            const ColorMapping& start, const MappingUnknowns& unknowns,
                            int first_stage) {
    ColorMapping mapping = start;
    for (std::size_t i = std::size_t(first_stage); i < fine_stages.size(); ++i) {
        const SolveStage stage{
            fine_stages[i], {true, unknowns.delay, unknowns.log_focal, true}, fine_iterations};
        mapping = solve_mapping(problem, chosen, mapping, stage).mapping;
    }
    return mapping;
}

std::vector<HeldOut> hold_out(const RimViews& problem, const ColorMapping& mapping,
                              const MappingUnknowns& unknowns) {
    const std::size_t count = problem.views.size();
    const std::size_t parts = count >= frames_for_quarters ? 4 : 3;
    std::vector<HeldOut> result(parts);
    for (std::size_t part = 0; part < parts; ++part) {
        std::vector<int> others;
        for (std::size_t i = 0; i < count; ++i)
            (i * parts / count == part ? result[part].frames : others).push_back(int(i));
        result[part].mapping = refine_mapping(problem, others, mapping, unknowns, 2);
    }
    return result;
}

MappingUncertainty uncertainty_of(const RimViews& problem, const ColorMapping& mapping,
                                  std::span<const HeldOut> held_out) {
    const MappingStep center = parameters_of(mapping);
    MappingStep squares{};
    double square_px = 0;
    for (const HeldOut& part : held_out) {
        const MappingStep value = parameters_of(part.mapping);
        for (std::size_t k = 0; k < center.size(); ++k)
            squares[k] += (value[k] - center[k]) * (value[k] - center[k]);
        const double shift = mapping_shift(problem, part.mapping, mapping);
        square_px += shift * shift;
    }
    const double share = (double(held_out.size()) - 1) / double(held_out.size());
    MappingUncertainty result;
    for (std::size_t k = 0; k < center.size(); ++k)
        result.parameters[k] = std::sqrt(share * squares[k]);
    result.px = std::sqrt(share * square_px);
    return result;
}

}  // namespace inlay
