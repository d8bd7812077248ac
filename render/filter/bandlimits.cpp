// Bandwidths and widths as plain functions of scalars.
#include "render/filter/bandlimits.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr double thesis_cosine_bandlimit = 1.0;
constexpr double samples_of_unit_width = 16;

/// n of cos^n, whose 99 % bandwidth is 1.82 sqrt(n).
double lobe_exponent(double glossy) { return glossy * glossy / (1.82 * 1.82); }

double corrected_inverse_width(const LocalFrequencies& f, LightKind light,
                               const FilterSettings& s) {
    const double turning =
        std::abs(f.curvature) * (cosine_bandlimit + 2 * f.glossy) / s.curvature_safety;
    const double passing = light == LightKind::indirect
                               ? transfer_bandlimit(f.glossy)
                               : cosine_bandlimit + f.environment + f.glossy;
    return turning + f.occluder * passing / s.visibility_safety;
}

}  // namespace

double clamped_bandwidth(double bandwidth) {
    if (std::isnan(bandwidth)) return largest_bandwidth;
    return std::clamp(bandwidth, 0.0, largest_bandwidth);
}

double occluder_rate(double cosine, double r) { return clamped_bandwidth(cosine / r); }

double direct_bandwidth(const LocalFrequencies& f) {
    const double shear = std::max(std::abs(f.curvature + f.occluder), 0.1 * f.occluder);
    return clamped_bandwidth(shear * cosine_bandlimit +
                             std::abs(2 * f.curvature + f.occluder) * f.glossy +
                             f.occluder * f.environment);
}

double transfer_bandlimit(double glossy) {
    return std::sqrt(3.65 * 3.65 + 3.93 * lobe_exponent(glossy));
}

double indirect_bandwidth(const LocalFrequencies& f) {
    return clamped_bandwidth(std::abs(f.curvature) * (cosine_bandlimit + 2 * f.glossy) +
                             f.occluder * transfer_bandlimit(f.glossy));
}

double thesis_direct_bandwidth(const LocalFrequencies& f) {
    const double receiver = thesis_cosine_bandlimit + 2 * f.glossy;
    return clamped_bandwidth(
        std::abs(f.curvature * receiver + f.occluder * (receiver + f.environment)));
}

double thesis_indirect_bandwidth(const LocalFrequencies& f) {
    const double limit = f.glossy > 0 ? 4.27 + 0.15 * lobe_exponent(f.glossy) : 2.8;
    return clamped_bandwidth(f.occluder * limit);
}

double durand_bandwidth(const LocalFrequencies& f) {
    const double lobe = f.glossy > 0 ? f.glossy : thesis_cosine_bandlimit;
    return clamped_bandwidth(std::abs(2 * f.curvature + f.occluder) * lobe);
}

double inverse_width(const LocalFrequencies& f, LightKind light, const FilterSettings& settings) {
    if (settings.constants == FilterConstants::thesis) {
        return 2 * (light == LightKind::direct ? thesis_direct_bandwidth(f)
                                               : thesis_indirect_bandwidth(f));
    }
    if (settings.constants == FilterConstants::durand) return 2 * durand_bandwidth(f);
    return clamped_bandwidth(corrected_inverse_width(f, light, settings));
}

double sample_factor(int samples, const FilterSettings& settings) {
    if (settings.constants != FilterConstants::corrected) return 1;
    return std::pow(samples_of_unit_width / std::max(samples, 1), 0.25);
}

double pair_curvature(const glm::vec3& p, const glm::vec3& n, const glm::vec3& p_next,
                      const glm::vec3& n_next, double footprint) {
    const float angle = std::atan2(glm::length(glm::cross(n, n_next)), glm::dot(n, n_next));
    if (angle == 0) return 0;
    const glm::vec3 step = p_next - p;
    const double distance = std::max(double(glm::length(step)), footprint / 4);
    const double curvature = clamped_bandwidth(double(angle) / distance);
    return glm::dot(n_next - n, step) < 0 ? -curvature : curvature;
}

}  // namespace inlay
