#include "render/sample/environment_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <utility>

namespace inlay {
namespace {

void check_texels(const Image<Rgb>& map) {
    require(!map.empty(), "the environment map has no pixels");
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const Rgb& c = map(x, y);
            const bool good = c.r >= 0 && c.g >= 0 && c.b >= 0 && std::isfinite(c.r + c.g + c.b);
            require(good, "environment map, texel (" + std::to_string(x) + ", " +
                              std::to_string(y) + "): radiance must be finite and not negative");
        }
    }
}

/// FNV-1a over the words of `count` values.
template <class Value>
std::uint64_t fingerprint_of(const Value* values, std::size_t count, std::uint64_t start) {
    static_assert(sizeof(Value) % sizeof(std::uint32_t) == 0);
    const auto* bytes = reinterpret_cast<const std::byte*>(values);
    for (std::size_t at = 0; at < count * sizeof(Value); at += sizeof(std::uint32_t)) {
        std::uint32_t word = 0;
        std::memcpy(&word, bytes + at, sizeof(word));
        start = (start ^ word) * 0x100000001b3U;
    }
    return start;
}

std::uint64_t fingerprint_of(const EnvironmentMap& map) {
    constexpr std::uint64_t basis = 0xcbf29ce484222325U;
    const std::uint64_t turned =
        fingerprint_of(&map.world_from_environment, 1, basis ^ std::uint64_t(map.radiance.width));
    return fingerprint_of(map.radiance.pixels.data(), map.radiance.pixels.size(), turned);
}

}  // namespace

EnvironmentSampler make_environment_sampler(EnvironmentMap map) {
    const Image<Rgb>& radiance = map.radiance;
    check_texels(radiance);
    EnvironmentSampler sampler;
    std::vector<double> row_weights;
    bool black = true;
    for (const Rgb& c : radiance.pixels)
        black = black && luminance(c) <= 0;
    for (int y = 0; y < radiance.height; ++y) {
        std::vector<double> weights;
        for (const Rgb& c : radiance.row(y))
            weights.push_back(black ? 1.0 : luminance(c));
        sampler.texels.push_back(make_discrete_table(weights));
        row_weights.push_back(sampler.texels.back().total * texel_solid_angle(radiance, y));
    }
    sampler.rows = make_discrete_table(row_weights);
    for (int y = 0; y <= radiance.height; ++y)
        sampler.row_cosines.push_back(std::cos(std::numbers::pi * y / radiance.height));
    if (!black) sampler.mean_luminance = float(sampler.rows.total / (4 * std::numbers::pi));
    sampler.fingerprint = fingerprint_of(map);
    sampler.map = std::move(map);
    return sampler;
}

EnvironmentSampler make_light_list(EnvironmentMap map, int length, std::uint32_t seed) {
    require(length > 0,
            "light list: its length is " + std::to_string(length) + ", expected 1 or more",
            ExitCode::usage);
    EnvironmentSampler sampler = make_environment_sampler(std::move(map));
    std::vector<LightSample> list;
    list.reserve(std::size_t(length));
    for (int i = 0; i < length; ++i) {
        const SampleKey key{seed, 0, 0, std::uint32_t(i)};
        const double first = (i + double(uniform(key, 0))) / length;
        list.push_back(sample_environment(
            sampler, {std::min(float(first), std::nextafter(1.0f, 0.0f)), uniform(key, 1)}));
    }
    sampler.fingerprint = fingerprint_of(list.data(), list.size(), sampler.fingerprint);
    sampler.list = std::move(list);
    return sampler;
}

LightSample sample_environment(const EnvironmentSampler& sampler, glm::vec2 u) {
    if (!sampler.list.empty()) {
        const auto at = std::size_t(double(u.x) * double(sampler.list.size()));
        return sampler.list[std::min(at, sampler.list.size() - 1)];
    }
    const Image<Rgb>& radiance = sampler.map.radiance;
    const DiscreteSample row = sample_discrete(sampler.rows, u.x);
    const DiscreteSample column = sample_discrete(sampler.texels[std::size_t(row.index)], u.y);
    const double top = sampler.row_cosines[std::size_t(row.index)];
    const double bottom = sampler.row_cosines[std::size_t(row.index) + 1];
    const double solid_angle = (top - bottom) * 2 * std::numbers::pi / radiance.width;
    const double pdf = row.probability * column.probability / solid_angle;
    if (!(pdf > 0)) return {glm::vec3(0, 1, 0), Rgb(0), 0};

    const double cosine = top + row.rest * (bottom - top);
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    const double longitude =
        2 * std::numbers::pi * (0.5 - (column.index + column.rest) / radiance.width);
    const glm::dvec3 in_map{sine * std::sin(longitude), cosine, sine * std::cos(longitude)};
    return {glm::vec3(sampler.map.world_from_environment * in_map),
            radiance(column.index, row.index), float(pdf)};
}

LightSample sample_along(const EnvironmentSampler& sampler, const glm::vec3& direction) {
    const Image<Rgb>& radiance = sampler.map.radiance;
    const glm::dvec3 in_map =
        glm::transpose(sampler.map.world_from_environment) * glm::dvec3(direction);
    const glm::dvec2 texel = texel_from_direction(radiance, in_map);
    const int x = std::min(int(texel.x), radiance.width - 1);
    const int y = std::min(int(texel.y), radiance.height - 1);
    const double probability =
        probability_of(sampler.rows, y) * probability_of(sampler.texels[std::size_t(y)], x);
    return {direction, radiance(x, y), float(probability / texel_solid_angle(radiance, y))};
}

float pdf_environment(const EnvironmentSampler& sampler, const glm::vec3& direction) {
    return sample_along(sampler, direction).pdf;
}

}  // namespace inlay
