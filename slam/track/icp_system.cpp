#include "slam/track/icp_system.h"

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

/// What becomes of one observed point.
enum class Fate { unseen, seen, paired };

struct Pair {
    Fate fate = Fate::unseen;
    glm::vec3 point{0};   // m, observed, in the model's camera
    glm::vec3 normal{0};  // of the model
    float residual = 0;   // m, from the point to the model's plane
    float sigma = 1;      // m, of the residual
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

    Pair pair_of(std::size_t pixel) const {
        Pair pair;
        const glm::vec3& seen = observed_.position.pixels[pixel];
        pair.point = rotation_ * seen + translation_;
        const int at = view_.pixel_of(pair.point);
        if (at < 0) return pair;
        const auto hit = std::size_t(at);
        const glm::vec3& surface = model_.position.pixels[hit];
        if (surface.z <= 0 || model_.confidence.pixels[hit] <= 0) return pair;
        pair.fate = Fate::seen;
        pair.normal = model_.normal.pixels[hit];
        const glm::vec3 between = surface - pair.point;
        const glm::vec3 turned = rotation_ * observed_.normal.pixels[pixel];
        if (glm::dot(between, between) > settings_.distance * settings_.distance) return pair;
        if (glm::dot(turned, pair.normal) < settings_.cosine) return pair;
        pair.fate = Fate::paired;
        pair.residual = glm::dot(between, pair.normal);
        pair.sigma = depth_sigma(seen.z);
        return pair;
    }

private:
    const SurfaceMap& observed_;
    const SurfaceMap& model_;
    CameraView view_;
    glm::mat3 rotation_;
    glm::vec3 translation_;
    PairingSettings settings_;
};

void add(IcpSystem& system, const Pair& pair, float scale) {
    ++system.pairs;
    system.distance += glm::length(pair.point);
    const float deviation = std::abs(pair.residual) / (pair.sigma * scale);
    if (deviation < inlier_bound) {
        ++system.inliers;
        system.squared_residual += double(pair.residual) * double(pair.residual);
    }
    if (deviation >= tukey) return;
    const float kept = 1 - deviation * deviation / (tukey * tukey);
    const double weight = double(kept * kept) / (double(pair.sigma) * double(pair.sigma));
    const glm::vec3 turn = glm::cross(pair.point, pair.normal);
    const std::array<double, 6> j{turn.x,        turn.y,        turn.z,
                                  pair.normal.x, pair.normal.y, pair.normal.z};
    std::size_t entry = 0;
    for (std::size_t row = 0; row < 6; ++row) {
        const double weighted = weight * j[row];
        for (std::size_t column = row; column < 6; ++column) {
            system.a[entry++] += weighted * j[column];
        }
        system.b[row] += weighted * double(pair.residual);
    }
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
        IcpSystem row;
        for (int x = 0; x < observed.lens.width; ++x) {
            if (!observed.has_surface(x, y)) continue;
            ++row.observed;
            const Pair pair = pairing.pair_of(observed.position.index(x, y));
            row.seen += pair.fate != Fate::unseen;
            if (pair.fate == Fate::paired) add(row, pair, settings.scale);
        }
        rows[std::size_t(y)] = row;
    });
    IcpSystem sum;
    for (const IcpSystem& row : rows)
        add(sum, row);
    return sum;
}

float residual_scale(const SurfaceMap& observed, const SurfaceMap& model,
                     const Pose& model_from_observed, const PairingSettings& settings) {
    const Pairing pairing(observed, model, model_from_observed, settings);
    std::vector<std::vector<float>> rows(std::size_t(observed.lens.height / scale_stride));
    parallel_for(int(rows.size()), [&](int i) {
        for (int x = 0; x < observed.lens.width; ++x) {
            if (!observed.has_surface(x, i * scale_stride)) continue;
            const Pair pair = pairing.pair_of(observed.position.index(x, i * scale_stride));
            if (pair.fate != Fate::paired) continue;
            rows[std::size_t(i)].push_back(std::abs(pair.residual) / pair.sigma);
        }
    });
    std::vector<float> all;
    for (const auto& row : rows)
        all.insert(all.end(), row.begin(), row.end());
    if (all.empty()) return 0;
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    return 1.4826f * *middle;
}

}  // namespace inlay
