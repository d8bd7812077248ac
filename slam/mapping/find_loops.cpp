#include "slam/mapping/find_loops.h"

#include "slam/landmarks/match_landmarks.h"
#include "slam/track/icp_system.h"
#include "slam/track/se3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace inlay {
namespace {

constexpr int width = 160;                // px, about
constexpr int levels = 2;                 // of a view's pyramid
constexpr int apart = 5;                  // views between two that may close a loop
constexpr int most_loops = 4;             // that end at one view: the oldest
constexpr std::size_t views_matched = 5;  // that have most landmarks in common
constexpr float least_overlap = 0.3f;     // of a view with the other
constexpr float least_inliers = 0.6f;     // share of the overlap
// Of the last motion between two views: where the next view may be.
constexpr std::array<double, 3> shares_of_motion{0.33, 0.67, 1};
constexpr PairingSettings wide{0.3f, 0.8f, 1};
constexpr PairingSettings close{0.04f, 0.8f, 1};

/// Every `stride`-th pixel.
SurfaceMap thinned(const SurfaceMap& map, int stride) {
    Lens lens = map.lens;
    lens.width /= stride;
    lens.height /= stride;
    lens.fx /= stride, lens.fy /= stride;
    lens.cx /= stride, lens.cy /= stride;
    SurfaceMap result = empty_surface_map(lens, map.world_from_camera);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            result.position(x, y) = map.position(x * stride, y * stride);
            result.normal(x, y) = map.normal(x * stride, y * stride);
            result.confidence(x, y) = map.confidence(x * stride, y * stride);
        }
    }
    return result;
}

/// The edge of a motion that ICP found, by what the pairs at its end know, per pair.
PoseEdge edge_of(int from, int to, const Pose& motion, std::span<const LoopView> views) {
    const SurfaceMap& model = views[std::size_t(from)].pyramid.front();
    const SurfaceMap& observed = views[std::size_t(to)].pyramid.front();
    const IcpSystem system = icp_system(observed, model, motion, close);
    PoseEdge edge{from, to, motion, system.a};
    for (double& entry : edge.information)
        entry /= std::max(1, system.inliers);
    for (const std::size_t diagonal : {0, 6, 11, 15, 18, 20})
        edge.information[diagonal] += 1;  // views without pairs still know the motion somehow
    return edge;
}

TrackSettings of_views(TrackSettings settings) {
    settings.levels = levels;
    return settings;
}

/// Whether two views may show the same surfaces from where they stand.
bool may_meet(const LoopView& a, const LoopView& b) {
    const Pose expected = inverse(a.world_from_camera) * b.world_from_camera;
    const IcpSystem pairs = icp_system(b.pyramid.back(), a.pyramid.front(), expected, wide);
    return pairs.pairs > 0 && float(pairs.pairs) >= least_overlap * float(pairs.observed);
}

/// An earlier view that shows landmarks of a later one, and where they place that.
struct SharedLandmarks {
    int from = 0;
    Pose second_in_world;  // world_from_camera
};

/// The earlier views with most in common with view `to`.
std::vector<SharedLandmarks> landmarks_shared(std::span<const LoopView> views, int to) {
    const Landmarks& landmarks = views[std::size_t(to)].landmarks;
    std::vector<SharedLandmarks> shared;
    if (landmarks.descriptor.empty()) return shared;
    std::vector<std::pair<int, int>> ranks;  // minus the likeness, and the view
    for (int from = 0; from + apart <= to; ++from)
        ranks.emplace_back(-likeness(views[std::size_t(from)].landmarks, landmarks), from);
    std::sort(ranks.begin(), ranks.end());
    ranks.resize(std::min(ranks.size(), views_matched));
    for (const auto& [rank, from] : ranks) {
        const LoopView& view = views[std::size_t(from)];
        if (const auto motion = match_landmarks(view.landmarks, landmarks))
            shared.push_back({from, view.world_from_camera * motion->from_to});
    }
    return shared;
}

/// The motion between two views, found from starts of the second, if the one shows enough of the
/// other and fits it.
std::optional<PoseEdge> try_pair(int from, int to, std::span<const LoopView> views,
                                 std::span<const Pose> starts, const TrackSettings& settings) {
    const LoopView &a = views[std::size_t(from)], &b = views[std::size_t(to)];
    SurfaceMap model = a.pyramid.front();
    model.world_from_camera = a.world_from_camera;
    const TrackResult found = track_frame(b.pyramid, model, starts, settings);
    if (found.status != TrackingStatus::tracked || found.overlap < least_overlap ||
        found.inlier_share < least_inliers) {
        return std::nullopt;
    }
    return edge_of(from, to, inverse(a.world_from_camera) * found.world_from_camera, views);
}

}  // namespace

LoopView make_loop_view(const SurfaceMap& seen, const Pose& world_from_camera,
                        Landmarks landmarks) {
    LoopView view{{thinned(seen, std::max(1, seen.lens.width / width))},
                  world_from_camera,
                  std::move(landmarks)};
    for (int level = 1; level < levels; ++level)
        view.pyramid.push_back(thinned(view.pyramid.back(), 2));
    return view;
}

std::vector<PoseEdge> chain_edges(std::span<const LoopView> views, const TrackSettings& settings) {
    std::vector<PoseEdge> edges;
    for (int i = 1; i < int(views.size()); ++i) {
        const Pose &before = views[std::size_t(i) - 1].world_from_camera,
                   &now = views[std::size_t(i)].world_from_camera;
        std::vector<Pose> starts{now};
        if (!edges.empty()) {
            const Twist motion = logarithm(edges.back().motion);
            for (const double share : shares_of_motion)
                starts.push_back(
                    before * exponential({share * motion.rotation, share * motion.translation}));
        }
        const auto found = try_pair(i - 1, i, views, starts, of_views(settings));
        edges.push_back(found ? *found : edge_of(i - 1, i, inverse(before) * now, views));
    }
    return edges;
}

std::vector<PoseEdge> find_loops(std::span<const LoopView> views, const TrackSettings& settings) {
    std::vector<PoseEdge> edges;
    for (int to = apart; to < int(views.size()); ++to) {
        const LoopView& second = views[std::size_t(to)];
        int loops = 0;
        const auto try_from = [&](int from, const Pose& start) {
            if (loops == most_loops) return;
            const auto edge = try_pair(from, to, views, std::span(&start, 1), of_views(settings));
            if (edge) edges.push_back(*edge);
            loops += edge.has_value();
        };
        for (int from = 0; from + apart <= to && loops < most_loops; ++from)
            if (may_meet(views[std::size_t(from)], second))
                try_from(from, second.world_from_camera);
        if (loops > 0) continue;
        for (const SharedLandmarks& shared : landmarks_shared(views, to))
            try_from(shared.from, shared.second_in_world);
    }
    return edges;
}

LoopError loop_error(const PoseEdge& edge, std::span<const LoopView> views) {
    const Pose motion = inverse(views[std::size_t(edge.from)].world_from_camera) *
                        views[std::size_t(edge.to)].world_from_camera;
    const Pose off = motion * inverse(edge.motion);
    return {glm::length(off.translation), rotation_angle(Pose{}, off)};
}

}  // namespace inlay
