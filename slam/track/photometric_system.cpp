#include "slam/track/photometric_system.h"

#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace inlay {
namespace {

constexpr float tukey = 4.685f;        // standard deviations: 95 % efficiency on Gaussian noise
constexpr float inlier_bound = 3.0f;   // standard deviations
constexpr float least_scale = 0.001f;  // of the values: below lies the rounding to 8 bits
constexpr int scale_stride = 2;        // rows
constexpr std::size_t unknowns = 7;    // the twist and the gain

/// An observed point and the model's brightness where it appears.
struct Pair {
    glm::vec3 point;  // m, in the model's camera
    float observed = 0;
    Brightness model;
    bool slopes = false;  // enough to tell of motion
};

class Comparison {
public:
    Comparison(const SeenBrightness& observed, const SeenBrightness& model,
               const Pose& model_from_observed, const BrightnessSettings& settings)
        : observed_(observed),
          model_(model),
          surface_view_(camera_view(model.surface.lens)),
          bent_(distorted(model.brightness.lens)),
          rotation_(model_from_observed.rotation),
          translation_(model_from_observed.translation),
          settings_(settings) {}

    std::optional<Pair> pair_of(int x, int y) const {
        const glm::vec3& seen = observed_.surface.position(x, y);
        Pair pair{rotation_ * seen + translation_, observed_.brightness.pixels(x, y).value, {}};
        if (!(seen.z > 0 && pair.observed > 0) || !same_surface(pair.point)) return std::nullopt;
        const Lens& lens = model_.brightness.lens;
        pair.model = brightness_at(model_.brightness, position_of(pair.point));
        if (!(pair.model.value > 0)) return std::nullopt;
        const glm::vec2 per_pixel =
            pair.model.slope / glm::vec2(float(std::abs(lens.fx)), float(std::abs(lens.fy)));
        pair.slopes = glm::length(per_pixel) >= settings_.least_slope;
        return pair;
    }

private:
    bool same_surface(const glm::vec3& point) const {
        const int pixel = surface_view_.pixel_of(point);
        if (pixel < 0) return false;
        const glm::vec3& surface = model_.surface.position.pixels[std::size_t(pixel)];
        return surface.z > 0 && model_.surface.confidence.pixels[std::size_t(pixel)] > 0 &&
               glm::distance(surface, point) <= settings_.distance;
    }

    /// Where a point that surface_view_ sees appears in the model's photograph (px).
    glm::vec2 position_of(const glm::vec3& p) const {
        const Lens& lens = model_.brightness.lens;
        if (bent_) return glm::vec2(project(lens, glm::dvec3(p)));
        return {float(lens.fx) * p.x / p.z + float(lens.cx),
                float(lens.fy) * p.y / p.z + float(lens.cy)};
    }

    SeenBrightness observed_, model_;
    CameraView surface_view_;
    bool bent_;
    glm::mat3 rotation_;
    glm::vec3 translation_;
    BrightnessSettings settings_;
};

/// The system of twist and gain.
struct Sums {
    std::array<double, unknowns*(unknowns + 1) / 2> a{};
    std::array<double, unknowns> b{};
    double squared_residual = 0;
    int seen = 0, pairs = 0, inliers = 0;
};

void add(Sums& sums, const Pair& pair, const BrightnessSettings& settings) {
    ++sums.seen;
    if (!pair.slopes) return;
    ++sums.pairs;
    const float residual = settings.gain * pair.observed - pair.model.value;
    const float deviation = std::abs(residual) / settings.scale;
    if (deviation < inlier_bound) {
        ++sums.inliers;
        sums.squared_residual += double(residual) * double(residual);
    }
    if (!(deviation < tukey)) return;
    const float kept = 1 - deviation * deviation / (tukey * tukey);
    const float weight = kept * kept / (settings.scale * settings.scale);
    const glm::vec3& p = pair.point;
    const glm::vec2 slope = pair.model.slope / p.z;  // per metre across the line of sight
    const glm::vec3 per_metre(slope, -(slope.x * p.x + slope.y * p.y) / p.z);
    const glm::vec3 turn = glm::cross(p, per_metre);
    const std::array<float, unknowns> j{turn.x,      turn.y,      turn.z,        per_metre.x,
                                        per_metre.y, per_metre.z, -pair.observed};
    std::size_t entry = 0;
    for (std::size_t row = 0; row < unknowns; ++row) {
        for (std::size_t column = row; column < unknowns; ++column)
            sums.a[entry++] += double(weight * j[row] * j[column]);
        sums.b[row] += double(weight * j[row] * residual);
    }
}

void add(Sums& sum, const Sums& part) {
    for (std::size_t i = 0; i < sum.a.size(); ++i)
        sum.a[i] += part.a[i];
    for (std::size_t i = 0; i < sum.b.size(); ++i)
        sum.b[i] += part.b[i];
    sum.squared_residual += part.squared_residual;
    sum.seen += part.seen;
    sum.pairs += part.pairs;
    sum.inliers += part.inliers;
}

/// The system of the twist alone, whatever the gain.
PhotometricSystem without_gain(const Sums& sums) {
    PhotometricSystem system{{}, {}, sums.squared_residual, sums.seen, sums.pairs, sums.inliers};
    const double gain = sums.a.back();  // its information
    if (!(gain > 0)) return system;
    const auto entry_of = [](std::size_t row, std::size_t column) {
        return row * unknowns - row * (row + 1) / 2 + column;
    };
    std::size_t entry = 0;
    for (std::size_t row = 0; row < 6; ++row) {
        const double coupling = sums.a[entry_of(row, 6)] / gain;
        for (std::size_t column = row; column < 6; ++column)
            system.a[entry++] =
                sums.a[entry_of(row, column)] - coupling * sums.a[entry_of(column, 6)];
        system.b[row] = sums.b[row] - coupling * sums.b[6];
    }
    return system;
}

/// The pairs of every second row that tell of motion, in order.
std::vector<Pair> some_pairs(const SeenBrightness& observed, const Comparison& comparison) {
    std::vector<std::vector<Pair>> rows(std::size_t(observed.surface.lens.height / scale_stride));
    parallel_for(int(rows.size()), [&](int i) {
        for (int x = 0; x < observed.surface.lens.width; ++x) {
            const std::optional<Pair> pair = comparison.pair_of(x, i * scale_stride);
            if (pair && pair->slopes) rows[std::size_t(i)].push_back(*pair);
        }
    });
    std::vector<Pair> all;
    for (const auto& row : rows)
        all.insert(all.end(), row.begin(), row.end());
    return all;
}

/// The median over the pairs, of which there are some, of what `measure` gives.
template <class Measure>
float median(const std::vector<Pair>& pairs, Measure measure) {
    std::vector<float> values(pairs.size());
    std::transform(pairs.begin(), pairs.end(), values.begin(), measure);
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

PhotometricSystem photometric_system(const SeenBrightness& observed, const SeenBrightness& model,
                                     const Pose& model_from_observed,
                                     const BrightnessSettings& settings) {
    const Comparison comparison(observed, model, model_from_observed, settings);
    std::vector<Sums> rows(std::size_t(observed.surface.lens.height));
    parallel_rows(observed.surface.lens.height, [&](int y) {
        for (int x = 0; x < observed.surface.lens.width; ++x) {
            if (const std::optional<Pair> pair = comparison.pair_of(x, y))
                add(rows[std::size_t(y)], *pair, settings);
        }
    });
    Sums sum;
    for (const Sums& row : rows)
        add(sum, row);
    return without_gain(sum);
}

BrightnessSettings adapted(const BrightnessSettings& settings, const SeenBrightness& observed,
                           const SeenBrightness& model, const Pose& model_from_observed) {
    const Comparison comparison(observed, model, model_from_observed, settings);
    const std::vector<Pair> pairs = some_pairs(observed, comparison);
    BrightnessSettings result = settings;
    if (pairs.empty()) return result;
    result.gain = median(pairs, [](const Pair& pair) { return pair.model.value / pair.observed; });
    const float middle = median(pairs, [&](const Pair& pair) {
        return std::abs(result.gain * pair.observed - pair.model.value);
    });
    result.scale = std::max(1.4826f * middle, least_scale);
    return result;
}

}  // namespace inlay
