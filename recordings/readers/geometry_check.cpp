#include "recordings/readers/geometry_check.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace inlay {
namespace {

/// One way to read a recording.
struct Reading {
    std::string name;
    double depth_factor = 1;  // on the depth as opened
    Lens lens;
    enum class Poses { as_recorded, inverted, ignored } poses = Poses::as_recorded;
};

struct DepthView {
    Image<float> depth;  // m
    Pose world_from_camera;
};

struct FramePair {
    std::size_t from = 0, to = 0;  // places in the recording's list of frames
};

/// |z carried over - z measured|, absolute (m) and over z measured.
struct Errors {
    std::vector<double> metres, relative;
};

std::string shown(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::vector<Reading> readings_of(const RecordingInfo& info) {
    std::vector<Reading> readings{{"as opened", 1, info.lens}};
    for (const double scale : {1000.0, 5000.0, 6553.5})
        if (std::abs(scale / info.units_per_metre - 1) > 1e-6)
            readings.push_back(
                {"depth scale " + shown(scale), info.units_per_metre / scale, info.lens});
    readings.push_back({"poses inverted", 1, info.lens, Reading::Poses::inverted});
    readings.push_back({"poses ignored", 1, info.lens, Reading::Poses::ignored});
    Lens flipped = info.lens;
    flipped.fy = -flipped.fy;
    readings.push_back({"fy " + shown(flipped.fy), 1, flipped});
    if (distorted(info.lens))
        readings.push_back({"lens without distortion", 1, pinhole(info.lens)});
    return readings;
}

Pose to_from(const Reading& reading, const DepthView& from, const DepthView& to) {
    switch (reading.poses) {
        case Reading::Poses::inverted:
            return to.world_from_camera * inverse(from.world_from_camera);
        case Reading::Poses::ignored:
            return {};
        case Reading::Poses::as_recorded:
            break;
    }
    return inverse(to.world_from_camera) * from.world_from_camera;
}

Errors errors_of(const Reading& reading, const DepthView& from, const DepthView& to, int grid) {
    const Pose to_from_from = to_from(reading, from, to);
    Errors errors;
    for (int y = grid / 2; y < from.depth.height; y += grid) {
        for (int x = grid / 2; x < from.depth.width; x += grid) {
            const double z = from.depth(x, y) * reading.depth_factor;
            if (z <= 0) continue;
            const glm::dvec3 p = to_from_from * (z * unproject(reading.lens, {x, y}));
            if (p.z <= 0) continue;
            const auto pixel = nearest_pixel(reading.lens, project(reading.lens, p));
            if (!pixel) continue;
            const double measured = to.depth(pixel->x, pixel->y) * reading.depth_factor;
            if (measured <= 0) continue;
            errors.metres.push_back(std::abs(p.z - measured));
            errors.relative.push_back(std::abs(p.z - measured) / measured);
        }
    }
    return errors;
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// The farthest later frame whose view still overlaps that of `from`; the next one if none does.
std::optional<FramePair> partner_of(std::size_t from, const RecordingInfo& info,
                                    const GeometryCheckSettings& settings) {
    const Pose& a = *info.world_from_camera[from];
    std::optional<FramePair> pair;
    const std::size_t last =
        std::min(info.frames.size(), from + 1 + std::size_t(settings.max_step));
    for (std::size_t to = from + 1; to < last; ++to) {
        if (!info.world_from_camera[to]) continue;
        const Pose& b = *info.world_from_camera[to];
        const bool overlaps =
            rotation_angle(a, b) <= settings.max_rotation &&
            glm::distance(a.translation, b.translation) <= settings.max_translation;
        if (overlaps || !pair) pair = {from, to};
        if (!overlaps) break;
    }
    return pair;
}

std::vector<FramePair> choose_pairs(const RecordingInfo& info,
                                    const GeometryCheckSettings& settings) {
    std::vector<FramePair> possible;
    for (std::size_t from = 0; from + 1 < info.frames.size(); ++from)
        if (info.world_from_camera[from])
            if (const auto pair = partner_of(from, info, settings)) possible.push_back(*pair);
    const auto wanted = std::size_t(std::max(settings.pairs, 1));
    if (possible.size() <= wanted) return possible;
    std::vector<FramePair> chosen;
    for (std::size_t k = 0; k < wanted; ++k)
        chosen.push_back(possible[k * possible.size() / wanted]);
    return chosen;
}

std::optional<DepthView> load_view(const Recording& recording, std::size_t place) {
    try {
        return DepthView{recording.load(recording.info.frames[place]).depth,
                         *recording.info.world_from_camera[place]};
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// The errors of every reading on one pair; empty if a frame cannot be decoded.
std::vector<Errors> errors_on(const Recording& recording, const FramePair& pair,
                              const std::vector<Reading>& readings, int grid) {
    const auto from = load_view(recording, pair.from), to = load_view(recording, pair.to);
    std::vector<Errors> errors;
    if (!from || !to) return errors;
    for (const Reading& reading : readings)
        errors.push_back(errors_of(reading, *from, *to, std::max(grid, 1)));
    return errors;
}

GeometryResidual residual_of(const std::string& name, std::size_t reading,
                             const std::vector<std::vector<Errors>>& by_pair) {
    Errors all;
    for (const auto& errors : by_pair) {
        if (errors.empty()) continue;
        const Errors& e = errors[reading];
        all.metres.insert(all.metres.end(), e.metres.begin(), e.metres.end());
        all.relative.insert(all.relative.end(), e.relative.begin(), e.relative.end());
    }
    return {name, median(all.metres), median(all.relative), int(all.metres.size())};
}

std::optional<GeometryResidual> clearly_better(const std::vector<GeometryResidual>& results) {
    const GeometryResidual& chosen = results.front();
    std::optional<GeometryResidual> best;
    for (const GeometryResidual& r : results) {
        const bool clear = r.relative < 0.8 * chosen.relative &&
                           r.relative < chosen.relative - 0.001 && 4 * r.samples >= chosen.samples;
        if (clear && (!best || r.relative < best->relative)) best = r;
    }
    return best;
}

}  // namespace

GeometryCheck check_geometry(const Recording& recording, const GeometryCheckSettings& settings) {
    const RecordingInfo& info = recording.info;
    const std::vector<Reading> readings = readings_of(info);
    const std::vector<FramePair> pairs = choose_pairs(info, settings);
    std::vector<std::vector<Errors>> by_pair(pairs.size());
    parallel_for(int(pairs.size()), [&](int i) {
        const auto k = std::size_t(i);
        by_pair[k] = errors_on(recording, pairs[k], readings, settings.grid);
    });
    GeometryCheck check;
    std::vector<double> baselines;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (by_pair[k].empty()) continue;
        ++check.pairs;
        baselines.push_back(glm::distance(info.world_from_camera[pairs[k].from]->translation,
                                          info.world_from_camera[pairs[k].to]->translation));
    }
    if (check.pairs == 0) return check;
    check.baseline = median(baselines);
    for (std::size_t r = 0; r < readings.size(); ++r)
        check.results.push_back(residual_of(readings[r].name, r, by_pair));
    check.better = clearly_better(check.results);
    return check;
}

}  // namespace inlay
