#include "slam/track/icp_system.h"

#include "recordings/base/lanes.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/depth/filter_depth.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inlay {
namespace {

constexpr float tukey = 4.685f;       // standard deviations: 95 % efficiency on Gaussian noise
constexpr float inlier_bound = 3.0f;  // standard deviations
constexpr int scale_stride = 4;       // rows

/// What becomes of eight observed points.
struct Pairs {
    Lanes observed, seen, paired;  // each among the ones before
    Vectors point;                 // m, observed, in the model's camera
    Vectors normal;                // of the model
    Floats cosine;                 // of the angle between the normals
    Floats residual;               // m, from the point to the model's plane
    Floats sigma;                  // m, of the residual
};

/// Finds the pairs of one observed map with the model.
class Pairing {
public:
    Pairing(const SurfaceMap& observed, const SurfaceMap& model, const Pose& model_from_observed,
            const PairingSettings& settings)
        : observed_(observed),
          model_(model),
          view_(camera_view(model.lens)),
          rotation_(model_from_observed.rotation),
          translation_(model_from_observed.translation),
          settings_(settings) {}

    /// The pairs of pixels (x, y) to (x + 7, y).
    Pairs pairs_of(int x, int y) const {
        const int width = observed_.lens.width;
        const std::size_t row = observed_.position.index(0, y);
        const auto own = [&](const Image<glm::vec3>& map) {
            return gathered([&](auto lane) -> const glm::vec3& {
                return map.pixels[row + std::size_t(std::min(x + int(lane), width - 1))];
            });
        };
        Pairs pairs;
        const Vectors seen = own(observed_.position);
        pairs.observed = seen.z > 0 && lane_numbers() < float(width - x);
        pairs.point = transformed(rotation_, seen, translation_);
        pairs.sigma = depth_sigma(seen.z);
        const SeenAt at = view_.pixels_of(pairs.point);
        const auto others = [&](const Image<glm::vec3>& map) {
            return gathered([&](auto lane) -> const glm::vec3& {
                return map.pixels[std::size_t(at.pixel[lane])];
            });
        };
        const Floats confidence(
            [&](auto lane) { return model_.confidence.pixels[std::size_t(at.pixel[lane])]; });
        const Vectors surface = others(model_.position);
        pairs.seen = pairs.observed && at.seen && surface.z > 0 && confidence > 0;
        pairs.normal = others(model_.normal);
        const Vectors between{surface.x - pairs.point.x, surface.y - pairs.point.y,
                              surface.z - pairs.point.z};
        const Vectors turned = transformed(rotation_, own(observed_.normal));
        pairs.cosine = dot(turned, pairs.normal);
        pairs.paired = pairs.seen &&
                       dot(between, between) <= settings_.distance * settings_.distance &&
                       pairs.cosine >= settings_.cosine;
        pairs.residual = dot(between, pairs.normal);
        return pairs;
    }

private:
    const SurfaceMap& observed_;
    const SurfaceMap& model_;
    CameraView view_;
    glm::mat3 rotation_;
    glm::vec3 translation_;
    PairingSettings settings_;
};

/// Sums of one row, a lane for each eighth of its points.
struct RowSums {
    std::array<Floats, 21> a;
    std::array<Floats, 6> b;
    Floats squared_residual = 0, distance = 0;
    int observed = 0, seen = 0, pairs = 0, inliers = 0;

    RowSums() {
        a.fill(0);
        b.fill(0);
    }
};

void add(RowSums& sums, const Pairs& pairs, float scale) {
    sums.observed += popcount(pairs.observed);
    sums.seen += popcount(pairs.seen);
    if (none_of(pairs.paired)) return;
    sums.pairs += popcount(pairs.paired);
    where(pairs.paired, sums.distance) += stdx::sqrt(dot(pairs.point, pairs.point));
    const Floats deviation = stdx::abs(pairs.residual) / (pairs.sigma * scale);
    const Lanes inlier = pairs.paired && deviation < inlier_bound;
    sums.inliers += popcount(inlier);
    where(inlier, sums.squared_residual) += pairs.residual * pairs.residual;
    const Floats kept = 1 - deviation * deviation * (1 / (tukey * tukey));
    const Floats weight =
        choose(pairs.paired && deviation < tukey, kept * kept / (pairs.sigma * pairs.sigma), 0);
    const Vectors turn = cross(pairs.point, pairs.normal);
    const std::array<Floats, 6> j{turn.x,         turn.y,         turn.z,
                                  pairs.normal.x, pairs.normal.y, pairs.normal.z};
    std::size_t entry = 0;
    for (std::size_t row = 0; row < 6; ++row) {
        const Floats weighted = weight * j[row];
        for (std::size_t column = row; column < 6; ++column)
            sums.a[entry++] += weighted * j[column];
        sums.b[row] += weighted * pairs.residual;
    }
}

IcpSystem total(const RowSums& sums) {
    IcpSystem system;
    for (std::size_t i = 0; i < sums.a.size(); ++i)
        system.a[i] = double(stdx::reduce(sums.a[i]));
    for (std::size_t i = 0; i < sums.b.size(); ++i)
        system.b[i] = double(stdx::reduce(sums.b[i]));
    system.squared_residual = double(stdx::reduce(sums.squared_residual));
    system.distance = double(stdx::reduce(sums.distance));
    system.observed = sums.observed;
    system.seen = sums.seen;
    system.pairs = sums.pairs;
    system.inliers = sums.inliers;
    return system;
}

void add(IcpSystem& sum, const IcpSystem& part) {
    for (std::size_t i = 0; i < sum.a.size(); ++i)
        sum.a[i] += part.a[i];
    for (std::size_t i = 0; i < sum.b.size(); ++i)
        sum.b[i] += part.b[i];
    sum.squared_residual += part.squared_residual;
    sum.distance += part.distance;
    sum.observed += part.observed;
    sum.seen += part.seen;
    sum.pairs += part.pairs;
    sum.inliers += part.inliers;
}

}  // namespace

IcpSystem icp_system(const SurfaceMap& observed, const SurfaceMap& model,
                     const Pose& model_from_observed, const PairingSettings& settings) {
    const Pairing pairing(observed, model, model_from_observed, settings);
    std::vector<IcpSystem> rows(std::size_t(observed.lens.height));
    parallel_rows(observed.lens.height, [&](int y) {
        RowSums sums;
        for (int x = 0; x < observed.lens.width; x += lane_count)
            add(sums, pairing.pairs_of(x, y), settings.scale);
        rows[std::size_t(y)] = total(sums);
    });
    IcpSystem sum;
    for (const IcpSystem& row : rows)
        add(sum, row);
    return sum;
}

namespace {

/// The median over the pairs of every fourth row of what `measure` gives; 0 if there is no pair.
template <class Measure>
float median_over_pairs(const SurfaceMap& observed, const Pairing& pairing, Measure measure) {
    std::vector<std::vector<float>> rows(std::size_t(observed.lens.height / scale_stride));
    parallel_for(int(rows.size()), [&](int i) {
        for (int x = 0; x < observed.lens.width; x += lane_count) {
            const Pairs pairs = pairing.pairs_of(x, i * scale_stride);
            const auto values = numbers_of(measure(pairs));
            for (std::size_t lane = 0; lane < lane_count; ++lane)
                if (pairs.paired[lane]) rows[std::size_t(i)].push_back(values[lane]);
        }
    });
    std::vector<float> all;
    for (const auto& row : rows)
        all.insert(all.end(), row.begin(), row.end());
    if (all.empty()) return 0;
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return *middle;
}

}  // namespace

float residual_scale(const SurfaceMap& observed, const SurfaceMap& model,
                     const Pose& model_from_observed, const PairingSettings& settings) {
    const Pairing pairing(observed, model, model_from_observed, settings);
    return 1.4826f * median_over_pairs(observed, pairing, [](const Pairs& pairs) {
               return stdx::abs(pairs.residual) / pairs.sigma;
           });
}

float median_angle(const SurfaceMap& observed, const SurfaceMap& model,
                   const Pose& model_from_observed, const PairingSettings& settings) {
    const Pairing pairing(observed, model, model_from_observed, settings);
    const float turn = median_over_pairs(observed, pairing, [](const Pairs& pairs) {
        return 1 - pairs.cosine;  // grows with the angle
    });
    return std::acos(std::clamp(1 - turn, -1.0f, 1.0f));
}

}  // namespace inlay
