#include "slam/track/track_frame.h"

#include "recordings/base/check.h"
#include "slam/track/constrained_step.h"
#include "slam/track/filled_step.h"
#include "slam/track/icp_system.h"
#include "slam/track/photometric_system.h"
#include "slam/track/se3.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr double still_rotation = 2e-5;     // rad; smaller steps end a level
constexpr double still_translation = 2e-5;  // m
constexpr float least_scale = 0.3f;         // of depth_sigma(): below lies quantisation

/// The brightness of both photographs at every level, made when a level first asks for it.
class BrightnessLevels {
public:
    BrightnessLevels(std::span<const SurfaceMap> observed, const Photographs* photographs)
        : photographs_(photographs) {
        for (const SurfaceMap& level : observed)
            lenses_.push_back(level.lens);
    }

    bool there() const {
        return photographs_ && !photographs_->observed.empty() && !photographs_->model.empty();
    }
    const BrightnessMap& observed(int level) {
        make();
        return observed_[std::size_t(level)];
    }
    const BrightnessMap& model(int level) {
        make();
        return model_[std::size_t(level)];
    }

private:
    void make() {
        if (!observed_.empty()) return;
        observed_ = brightness_pyramid(photographs_->observed, lenses_);
        model_ = brightness_pyramid(photographs_->model, lenses_);
    }

    const Photographs* photographs_;
    std::vector<Lens> lenses_;
    std::vector<BrightnessMap> observed_, model_;
};

/// A pose being improved.
struct Attempt {
    Pose start, model_from_observed;
    int iterations = 0;
};

PairingSettings pairing_of(int level, const TrackSettings& settings) {
    const float share = settings.levels > 1 ? float(level) / float(settings.levels - 1) : 0.0f;
    const auto between = [&](float fine, float coarse) {
        return fine * std::pow(coarse / fine, share);
    };
    return {between(settings.fine_distance, settings.coarse_distance),
            std::cos(between(settings.fine_angle, settings.coarse_angle)), 1};
}

/// What is seen and what it is compared with.
struct Views {
    std::span<const SurfaceMap> observed;  // finest first
    const SurfaceMap& model;
    BrightnessLevels brightness;
};

/// The surfaces' step, filled in by brightness where they leave directions free.
Twist next_step(const Pose& model_from_observed, Views& views, int level,
                const PairingSettings& pairing, const TrackSettings& settings) {
    const SurfaceMap& surface = views.observed[std::size_t(level)];
    const IcpSystem system = icp_system(surface, views.model, model_from_observed, pairing);
    const ConstrainedStep step = constrained_step(system, double(settings.least_information));
    if (step.free_axes == 0 || !views.brightness.there()) return step.twist;
    const SeenBrightness observed{surface, views.brightness.observed(level)};
    const SeenBrightness model{views.model, views.brightness.model(level)};
    BrightnessSettings brightness;
    brightness.distance = pairing.distance;
    brightness = adapted(brightness, observed, model, model_from_observed);
    const PhotometricSystem light =
        photometric_system(observed, model, model_from_observed, brightness);
    return filled_step(step, system, light, {}).twist;
}

void solve_level(Attempt& attempt, Views& views, int level, const TrackSettings& settings) {
    const SurfaceMap& observed = views.observed[std::size_t(level)];
    const SurfaceMap& model = views.model;
    PairingSettings pairing = pairing_of(level, settings);
    PairingSettings wide = pairing;
    wide.cosine = std::cos(settings.coarse_angle);
    const float noise = median_angle(observed, model, attempt.model_from_observed, wide);
    if (noise > settings.noisy_angle) pairing = wide;
    for (int i = 0; i < settings.iterations; ++i) {
        const float scale = residual_scale(observed, model, attempt.model_from_observed, pairing);
        pairing.scale = std::max(scale, least_scale);
        const Twist step = next_step(attempt.model_from_observed, views, level, pairing, settings);
        attempt.model_from_observed =
            orthonormalized(exponential(step) * attempt.model_from_observed);
        ++attempt.iterations;
        if (glm::length(step.rotation) < still_rotation &&
            glm::length(step.translation) < still_translation) {
            break;
        }
    }
}

/// How well an attempt explains a level: inliers at the sensor's own noise, whatever the noise of
/// their normals.
IcpSystem verdict(const Attempt& attempt, const SurfaceMap& observed, const SurfaceMap& model,
                  int level, const TrackSettings& settings) {
    PairingSettings pairing = pairing_of(level, settings);
    pairing.cosine = std::cos(settings.coarse_angle);
    return icp_system(observed, model, attempt.model_from_observed, pairing);
}

Attempt best_attempt(Views& views, std::span<const Pose> starts, const TrackSettings& settings) {
    const int coarsest = int(views.observed.size()) - 1;
    const SurfaceMap& level = views.observed[std::size_t(coarsest)];
    Attempt best;
    int most = -1;
    for (const Pose& start : starts) {
        const Pose model_from_observed = inverse(views.model.world_from_camera) * start;
        Attempt attempt{model_from_observed, model_from_observed};
        solve_level(attempt, views, coarsest, settings);
        const int inliers = verdict(attempt, level, views.model, coarsest, settings).inliers;
        if (inliers <= most) continue;
        most = inliers;
        best = attempt;
    }
    return best;
}

bool plausible(const Attempt& attempt, const TrackSettings& settings) {
    const Pose move = inverse(attempt.start) * attempt.model_from_observed;
    return glm::length(move.translation) <= double(settings.largest_move) &&
           rotation_angle(Pose{}, move) <= double(settings.largest_turn);
}

std::string percent(float share) { return std::to_string(int(100 * share)) + " %"; }

/// Decides whether the result is to be believed, and says why where it is not.
void judge(TrackResult& result, bool plausible, const TrackSettings& settings) {
    result.status = TrackingStatus::lost;
    if (!plausible) {
        result.why = "it would have moved farther than a camera does";
    } else if (result.overlap < settings.least_overlap) {
        result.why = "only " + percent(result.overlap) + " of its points fall on the model";
    } else if (result.inlier_share < settings.tracked_share) {
        result.why = "only " + percent(result.inlier_share) + " of its points fit the model";
        if (result.inlier_share >= settings.weak_share) result.status = TrackingStatus::weak;
    }
    if (result.rms_residual > settings.largest_residual) {
        result.status = TrackingStatus::lost;
        result.why = "its points are " + std::to_string(int(1000 * result.rms_residual)) +
                     " mm off the model";
    }
    if (result.why.empty()) result.status = TrackingStatus::tracked;
}

}  // namespace

void validate(const TrackSettings& s) {
    require(s.levels >= 1 && s.levels <= 6 && s.iterations >= 1,
            "slam.track.levels must be 1..6 and slam.track.iterations 1 or more", ExitCode::usage);
    require(s.fine_distance > 0 && s.coarse_distance >= s.fine_distance,
            "slam.track.fine_distance must be above 0 and no more than slam.track.coarse_distance",
            ExitCode::usage);
    require(
        s.fine_angle > 0 && s.fine_angle <= s.coarse_angle && s.coarse_angle < 1.6f,
        "slam.track.fine_angle must be above 0 and no more than slam.track.coarse_angle, which is "
        "below 1.6 rad",
        ExitCode::usage);
    require(s.noisy_angle >= 0, "slam.track.noisy_angle must be 0 or more", ExitCode::usage);
    require(s.least_information >= 0, "slam.track.least_information must be 0 or more",
            ExitCode::usage);
    require(s.weak_share >= 0 && s.weak_share <= s.tracked_share && s.tracked_share <= 1,
            "slam.track.weak_share must be 0 or more and no more than slam.track.tracked_share, "
            "which is 1 at most",
            ExitCode::usage);
    require(s.least_overlap >= 0 && s.least_overlap <= 1, "slam.track.least_overlap must be 0..1",
            ExitCode::usage);
    require(s.largest_move > 0 && s.largest_turn > 0 && s.largest_residual > 0,
            "slam.track.largest_move, slam.track.largest_turn and slam.track.largest_residual must "
            "be above 0",
            ExitCode::usage);
}

TrackResult track_frame(std::span<const SurfaceMap> observed, const SurfaceMap& model,
                        std::span<const Pose> starts, const TrackSettings& settings,
                        const Photographs* photographs) {
    Views views{observed, model, BrightnessLevels(observed, photographs)};
    Attempt attempt = best_attempt(views, starts, settings);
    for (int level = int(observed.size()) - 2; level >= 0; --level)
        solve_level(attempt, views, level, settings);
    const IcpSystem system = verdict(attempt, observed.front(), model, 0, settings);
    TrackResult result;
    result.world_from_camera =
        orthonormalized(model.world_from_camera * attempt.model_from_observed);
    result.iterations = attempt.iterations;
    if (system.observed > 0) result.overlap = float(system.seen) / float(system.observed);
    if (system.seen > 0) result.inlier_share = float(system.inliers) / float(system.seen);
    if (system.inliers > 0) {
        result.rms_residual = float(std::sqrt(system.squared_residual / system.inliers));
    }
    judge(result, plausible(attempt, settings), settings);
    return result;
}

}  // namespace inlay
