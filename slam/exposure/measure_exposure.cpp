#include "slam/exposure/measure_exposure.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/sample_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace inlay {
namespace {

constexpr double most_samples = 2500;   // about; 1-2 ms
constexpr int least_samples = 100;      // of a channel, that agree
constexpr float least_cosine = 0.3f;    // of the angle of sight; gloss grows beyond
constexpr float reach = 3.0f / 640;     // of the photograph's width, from a patch's centre
constexpr float most_contrast = 0.25f;  // in a patch; more is an edge
constexpr float darkest = 0.02f;        // linear; below, black level and noise rule
constexpr float brightest = 0.9f;       // linear, of the model: byte 244
constexpr float least_weight = 1e-6f;   // of a saturated color; a grey one's is its square
constexpr int blocks = 4;               // along each side of the image
constexpr std::size_t block_count = blocks * blocks;
constexpr float log_range = 2;           // gains are sought in exp(-2)..exp(2)
constexpr int bins = 200;                // of that range
constexpr int bin_reach = 10;            // bins: half-width of the mode's triangle
constexpr int balance_bins = 40;         // between the modes of two channels: a factor of 2.2
constexpr float first_scale = 0.12f;     // standard deviation of a logarithm, about the mode
constexpr float least_scale = 0.02f;     // below quantisation
constexpr float most_scale = 0.15f;      // above, it is not the same surface
constexpr float tukey = 4.685f;          // standard deviations: 95 % efficiency on Gaussian noise
constexpr int scale_rounds = 5;          // of reweighting that also adapt the scale
constexpr int rounds = 8;                // of reweighting
constexpr float gain_band = 0.015f;      // dead band of the logarithm of the mean gain
constexpr float balance_band = 0.02f;    // of a channel's deviation from it
constexpr float standard_errors = 3.0f;  // that a deviation must exceed

/// A point where model and photograph were compared.
struct Sample {
    Rgb log_ratio{0};             // photograph over model
    glm::bvec3 known{false};      // the channels that have one
    float weight = least_weight;  // of all channels
    int block = 0;                // of the image
};

using Samples = std::vector<Sample>;

/// The mean of a pixel and four around it; empty at clipped pixels, edges and the border.
std::optional<Rgb> patch_mean(const Image<EncodedRgb>& photo, int x, int y) {
    const int r = std::max(1, int(std::lround(reach * float(photo.width))));
    if (!photo.contains(x - r, y - r) || !photo.contains(x + r, y + r)) return std::nullopt;
    Rgb sum(0), low(1), high(0);
    for (const glm::ivec2 step : {glm::ivec2(0, 0), glm::ivec2(r, 0), glm::ivec2(-r, 0),
                                  glm::ivec2(0, r), glm::ivec2(0, -r)}) {
        const EncodedRgb pixel = photo(x + step.x, y + step.y);
        if (std::max({pixel.r, pixel.g, pixel.b}) >= clipped_byte) return std::nullopt;
        const Rgb color = decode(pixel);
        sum += color;
        low = glm::min(low, color);
        high = glm::max(high, color);
    }
    const Rgb mean = sum / 5.0f;
    const Rgb contrast = (high - low) / (mean + darkest / 2);
    if (std::max({contrast.r, contrast.g, contrast.b}) > most_contrast) return std::nullopt;
    return mean;
}

/// Compares two linear colors; empty where no channel can be.
std::optional<Sample> compared(const Rgb& photo, const Rgb& model) {
    if (std::max({model.r, model.g, model.b}) > brightest) return std::nullopt;
    Sample sample;
    const Rgb squares = photo * model;  // symmetric: cuts neither side's noise
    for (int i = 0; i < 3; ++i) {
        sample.known[i] =
            squares[i] > darkest * darkest && std::min(photo[i], model[i]) > darkest / 4;
        if (sample.known[i]) sample.log_ratio[i] = std::log(photo[i] / model[i]);
    }
    if (!glm::any(sample.known)) return std::nullopt;
    sample.weight += std::min({squares.r, squares.g, squares.b});
    return sample;
}

/// Compares a photograph with the model.
class Comparison {
public:
    Comparison(const VoxelVolume& volume, const SurfaceMap& seen, const SeenColor& photo)
        : volume_(volume),
          seen_(seen),
          photo_(photo.image),
          view_(camera_view(photo.lens)),
          photo_from_seen_{glm::mat3(photo.color_from_depth.rotation),
                           glm::vec3(photo.color_from_depth.translation)},
          voxels_from_seen_{
              glm::mat3(seen.world_from_camera.rotation / double(volume.voxel_size)),
              glm::vec3(seen.world_from_camera.translation / double(volume.voxel_size))} {}

    std::optional<Sample> at(VolumeSampler& sampler, int x, int y) const {
        const glm::vec3 &p = seen_.position(x, y), &normal = seen_.normal(x, y);
        if (!(p.z > 0 && -glm::dot(p, normal) >= least_cosine * glm::length(p)))
            return std::nullopt;
        const int pixel = view_.pixel_of(photo_from_seen_(p));
        if (pixel < 0) return std::nullopt;
        const auto color = patch_mean(photo_, pixel % photo_.width, pixel / photo_.width);
        if (!color) return std::nullopt;
        const auto model = volume_color(sampler, voxels_from_seen_(p));
        if (!model) return std::nullopt;
        auto sample = compared(*color, *model);
        if (sample)
            sample->block = y * blocks / seen_.lens.height * blocks + x * blocks / seen_.lens.width;
        return sample;
    }

    Samples all() const {
        const double area = double(seen_.lens.width) * double(seen_.lens.height);
        const int stride = std::max(1, int(std::lround(std::sqrt(area / most_samples))));
        std::vector<Samples> rows(std::size_t(seen_.lens.height / stride));
        parallel_for(int(rows.size()), [&](int row) {
            VolumeSampler sampler(volume_);
            for (int x = stride / 2; x < seen_.lens.width; x += stride)
                if (const auto sample = at(sampler, x, row * stride + stride / 2))
                    rows[std::size_t(row)].push_back(*sample);
        });
        Samples samples;
        for (const Samples& row : rows)
            samples.insert(samples.end(), row.begin(), row.end());
        return samples;
    }

private:
    struct Motion {
        glm::mat3 linear;
        glm::vec3 offset;
        glm::vec3 operator()(const glm::vec3& p) const { return linear * p + offset; }
    };

    const VoxelVolume& volume_;
    const SurfaceMap& seen_;
    const Image<EncodedRgb>& photo_;
    CameraView view_;
    Motion photo_from_seen_, voxels_from_seen_;
};

/// How many logarithms fall into each bin, by weight.
using Histogram = std::array<float, bins>;

Histogram histogram_of(const Samples& samples, int channel) {
    Histogram histogram{};
    for (const Sample& sample : samples) {
        const float place = (sample.log_ratio[channel] + log_range) * (bins / (2 * log_range));
        if (sample.known[channel] && place >= 0 && place < bins)
            histogram[std::size_t(place)] += sample.weight;
    }
    return histogram;
}

/// The bin from `first` to `last` around which most logarithms crowd.
int crowded_bin(const Histogram& histogram, int first, int last) {
    int best = first;
    float most = -1;
    for (int bin = std::max(0, first); bin <= std::min(bins - 1, last); ++bin) {
        float crowd = 0;
        for (int i = std::max(0, bin - bin_reach); i <= std::min(bins - 1, bin + bin_reach); ++i)
            crowd += histogram[std::size_t(i)] * float(bin_reach + 1 - std::abs(i - bin));
        if (crowd > most) most = crowd, best = bin;
    }
    return best;
}

/// The mode of each channel's logarithms, not far from that of all of them.
std::array<float, 3> modes_of(const Samples& samples) {
    std::array<Histogram, 3> channels;
    Histogram all{};
    for (std::size_t i = 0; i < 3; ++i) {
        channels[i] = histogram_of(samples, int(i));
        for (std::size_t bin = 0; bin < bins; ++bin)
            all[bin] += channels[i][bin];
    }
    const int common = crowded_bin(all, 0, bins - 1);
    std::array<float, 3> modes{};
    for (std::size_t i = 0; i < 3; ++i) {
        const int bin = crowded_bin(channels[i], common - balance_bins, common + balance_bins);
        modes[i] = (float(bin) + 0.5f) * (2 * log_range / bins) - log_range;
    }
    return modes;
}

/// Where the logarithms of one channel crowd.
struct Centre {
    float value = 0;
    float error = 0;                          // standard error
    int samples = 0;                          // that are near; 0: too few
    std::array<double, block_count> pulls{};  // of each block on the value
};

/// What the samples near a value say about it.
struct Near {
    std::array<double, block_count> pulls{};  // weight * deviation, by block
    double weight = 0;
    std::vector<float> deviations;  // magnitudes
};

Near near(const Samples& samples, int channel, float value, float scale) {
    const float cut = tukey * scale;
    Near result;
    for (const Sample& sample : samples) {
        const float deviation = sample.log_ratio[channel] - value;
        if (!sample.known[channel] || std::abs(deviation) >= cut) continue;
        const float kept = 1 - deviation * deviation / (cut * cut);
        const double weight = double(sample.weight * kept * kept);
        result.pulls[std::size_t(sample.block)] += weight * double(deviation);
        result.weight += weight;
        result.deviations.push_back(std::abs(deviation));
    }
    return result;
}

/// Standard error of what the blocks pull on, at least that of `count` independent samples: within
/// a block, samples share what they suffer from.
float error_of(const std::array<double, block_count>& pulls, float scale, int count) {
    double squares = 0;
    for (const double pull : pulls)
        squares += pull * pull;
    return std::max(float(std::sqrt(squares)), scale / std::sqrt(float(count)));
}

/// Tukey's biweight mean from `start` on.
Centre centre_of(const Samples& samples, int channel, float start) {
    Centre centre{start};
    float scale = first_scale;
    for (int round = 0;; ++round) {
        Near seen = near(samples, channel, centre.value, scale);
        if (int(seen.deviations.size()) < least_samples) return {};
        double move = 0;
        for (std::size_t i = 0; i < block_count; ++i) {
            centre.pulls[i] = seen.pulls[i] / seen.weight;
            move += centre.pulls[i];
        }
        centre.samples = int(seen.deviations.size());
        centre.error = error_of(centre.pulls, scale, centre.samples);
        if (round == rounds) return centre;
        centre.value += float(move);
        if (round >= scale_rounds) continue;
        const auto middle = seen.deviations.begin() + std::ptrdiff_t(seen.deviations.size() / 2);
        std::nth_element(seen.deviations.begin(), middle, seen.deviations.end());
        scale = std::clamp(1.4826f * *middle, least_scale, most_scale);
    }
}

/// Nothing of a deviation within the band, all beyond twice the band (Gao and Bruce 1997, "firm
/// shrinkage").
float significant(float deviation, float band) {
    const float beyond = std::min(2 * (std::abs(deviation) - band), std::abs(deviation));
    return beyond > 0 ? std::copysign(beyond, deviation) : 0.0f;
}

/// The mean of the channels that are known; channels that nothing shows go with the others.
Centre common_of(std::array<Centre, 3>& centres) {
    Centre common;
    int known = 0;
    for (const Centre& centre : centres) {
        if (centre.samples == 0) continue;
        ++known;
        common.value += centre.value;
        common.error = std::max(common.error, centre.error);
        common.samples = std::max(common.samples, centre.samples);
        for (std::size_t i = 0; i < block_count; ++i)
            common.pulls[i] += centre.pulls[i];
    }
    if (known == 0) return common;
    common.value /= float(known);
    for (double& pull : common.pulls)
        pull /= known;
    for (Centre& centre : centres)
        if (centre.samples == 0) centre = common;
    return common;
}

/// What is significant of a channel's deviation from the mean of all.
float balance_of(const Centre& centre, const Centre& common) {
    std::array<double, block_count> pulls;
    for (std::size_t i = 0; i < block_count; ++i)
        pulls[i] = centre.pulls[i] - common.pulls[i];
    const float error = error_of(pulls, least_scale, centre.samples);
    return significant(centre.value - common.value,
                       std::max(balance_band, standard_errors * error));
}

}  // namespace

Exposure measure_exposure(const VoxelVolume& volume, const SurfaceMap& seen,
                          const SeenColor& photo) {
    require(photo.image.empty() ||
                (photo.image.width == photo.lens.width && photo.image.height == photo.lens.height),
            "the photograph and its lens differ in size");
    Exposure result;
    if (photo.image.empty() || volume.bricks.empty()) return result;
    const Samples samples = Comparison(volume, seen, photo).all();
    const std::array<float, 3> modes = modes_of(samples);
    std::array<Centre, 3> centres;
    for (std::size_t i = 0; i < 3; ++i)
        centres[i] = centre_of(samples, int(i), modes[i]);
    const Centre common = common_of(centres);
    if (common.samples == 0) return result;
    result.pixels = common.samples;
    const float gain =
        significant(common.value, std::max(gain_band, standard_errors * common.error));
    for (std::size_t i = 0; i < 3; ++i) {
        result.measured[int(i)] = std::exp(centres[i].value);
        result.uncertainty[int(i)] = centres[i].error;
        result.gain[int(i)] = std::exp(gain + balance_of(centres[i], common));
    }
    return result;
}

}  // namespace inlay
