#include "composite/session/settings.h"

#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <type_traits>
#include <utility>

namespace inlay {
namespace {

template <class Enum>
using Words = std::vector<std::pair<const char*, Enum>>;

[[noreturn]] void refuse(const std::string& name, const std::string& value,
                         const std::string& expected) {
    throw Error(ExitCode::usage, name + "=" + value + ": expected " + expected);
}

template <class Number>
void read_value(const std::string& name, const std::string& text, Number& value) {
    Number parsed{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, parsed);
    bool good = error == std::errc() && stop == end;
    if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(parsed);
    if (!good) refuse(name, text, std::is_integral_v<Number> ? "a whole number" : "a number");
    value = parsed;
}

void read_value(const std::string& name, const std::string& text, bool& value) {
    if (text != "on" && text != "off") refuse(name, text, "on or off");
    value = text == "on";
}

template <class Number>
std::string written(Number value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

std::string written(bool value) { return value ? "on" : "off"; }

/// `member` returns a reference to the setting within a (const or not) Settings.
template <class Member>
SettingRow row(const char* name, const char* unit, Member member) {
    return {name, unit, [member](const Settings& s) { return written(member(s)); },
            [member, name](Settings& s, const std::string& text) {
                read_value(name, text, member(s));
            }};
}

template <class Enum, class Member>
SettingRow choice(const char* name, Words<Enum> words, Member member) {
    std::string list;
    for (const auto& [word, value] : words)
        list += (list.empty() ? "" : "|") + std::string(word);
    return {name, list,
            [member, words](const Settings& s) {
                for (const auto& [word, value] : words)
                    if (value == member(s)) return std::string(word);
                return std::string();
            },
            [member, words, name, list](Settings& s, const std::string& text) {
                for (const auto& [word, value] : words) {
                    if (text != word) continue;
                    member(s) = value;
                    return;
                }
                refuse(name, text, list);
            }};
}

#define INLAY_MEMBER(path) \
    [](auto& s) -> auto& { return s.path; }

std::vector<SettingRow> slam_rows() {
    return {
        row("slam.voxel_size", "m", INLAY_MEMBER(slam.fusion.voxel_size)),
        row("slam.truncation", "m", INLAY_MEMBER(slam.fusion.truncation)),
        row("slam.max_weight", "observations", INLAY_MEMBER(slam.fusion.max_weight)),
        row("slam.least_cosine", "1", INLAY_MEMBER(slam.fusion.least_cosine)),
        row("slam.nearest", "m", INLAY_MEMBER(slam.raycast.nearest)),
        row("slam.farthest", "m", INLAY_MEMBER(slam.raycast.farthest)),
        row("slam.iterations", "per level", INLAY_MEMBER(slam.track.iterations)),
        row("slam.coarse_distance", "m", INLAY_MEMBER(slam.track.coarse_distance)),
        row("slam.fine_distance", "m", INLAY_MEMBER(slam.track.fine_distance)),
        row("slam.tracked_share", "0..1", INLAY_MEMBER(slam.track.tracked_share)),
        row("slam.weak_share", "0..1", INLAY_MEMBER(slam.track.weak_share)),
        choice<bool>("slam.poses", {{"tracked", false}, {"recorded", true}},
                     INLAY_MEMBER(use_recorded_poses)),
    };
}

std::vector<SettingRow> render_rows() {
    return {
        choice<RealGeometryKind>("geometry.kind",
                                 {{"screen", RealGeometryKind::screen},
                                  {"map", RealGeometryKind::map},
                                  {"model", RealGeometryKind::model}},
                                 INLAY_MEMBER(geometry.kind)),
        row("geometry.offset", "m", INLAY_MEMBER(geometry.offset)),
        row("geometry.visibility_tolerance", "m", INLAY_MEMBER(geometry.visibility_tolerance)),
        row("geometry.max_step", "share of depth", INLAY_MEMBER(geometry.max_step)),
        row("geometry.model_interval", "frames", INLAY_MEMBER(geometry.model_interval)),
        row("geometry.screen_thickness", "m", INLAY_MEMBER(geometry.screen.thickness)),
        row("geometry.screen_thickness_per_depth", "1",
            INLAY_MEMBER(geometry.screen.thickness_per_depth)),
        row("geometry.screen_offset", "m", INLAY_MEMBER(geometry.screen.offset)),
        row("trace.primary", "rays per pixel", INLAY_MEMBER(trace.primary)),
        row("trace.secondary", "samples per primary ray", INLAY_MEMBER(trace.secondary)),
        row("trace.seed", "", INLAY_MEMBER(trace.seed)),
        row("trace.depth_tolerance", "share of depth", INLAY_MEMBER(trace.depth_tolerance)),
        row("trace.occluder_floor", "share of depth", INLAY_MEMBER(trace.occluder_floor)),
        row("trace.ignored_luminance", "share of the mean", INLAY_MEMBER(trace.ignored_luminance)),
        row("filter.enabled", "on|off", INLAY_MEMBER(filter.enabled)),
        choice<FilterConstants>(
            "filter.constants",
            {{"corrected", FilterConstants::corrected}, {"thesis", FilterConstants::thesis}},
            INLAY_MEMBER(filter.constants)),
        row("filter.real_curvature", "on|off", INLAY_MEMBER(filter.real_curvature)),
        row("filter.rate_reach", "px", INLAY_MEMBER(filter.rate_reach)),
        row("filter.curvature_safety", "s_k", INLAY_MEMBER(filter.curvature_safety)),
        row("filter.visibility_safety", "s_v", INLAY_MEMBER(filter.visibility_safety)),
        row("filter.kernel_radius", "px", INLAY_MEMBER(filter.kernel_radius)),
        row("filter.narrowest_width", "px", INLAY_MEMBER(filter.narrowest_width)),
        row("filter.normal_stop_deg", "degrees", INLAY_MEMBER(filter.normal_stop_deg)),
        row("filter.temporal", "on|off", INLAY_MEMBER(filter.temporal)),
        row("filter.rejection_distance", "px", INLAY_MEMBER(filter.rejection_distance)),
        choice<BlendForm>("blend.form",
                          {{"ratio", BlendForm::ratio}, {"additive", BlendForm::additive}},
                          INLAY_MEMBER(blend.form)),
        row("blend.epsilon_share", "of the mean E_R", INLAY_MEMBER(blend.epsilon_share)),
        row("blend.max_ratio", "1", INLAY_MEMBER(blend.max_ratio)),
    };
}

#undef INLAY_MEMBER

}  // namespace

void validate(const Settings& s) {
    validate(s.slam);
    validate(s.trace);
    validate(s.filter);
    validate(s.blend);
    validate(s.geometry.screen);
    require(s.geometry.offset >= 0, "geometry.offset must not be negative", ExitCode::usage);
    require(s.geometry.visibility_tolerance > 0, "geometry.visibility_tolerance must be positive",
            ExitCode::usage);
    require(s.geometry.max_step > 0, "geometry.max_step must be positive", ExitCode::usage);
    require(s.geometry.model_interval >= 1, "geometry.model_interval must be 1 or more",
            ExitCode::usage);
}

const std::vector<SettingRow>& setting_rows() {
    static const std::vector<SettingRow> rows = [] {
        std::vector<SettingRow> all = slam_rows();
        for (SettingRow& r : render_rows())
            all.push_back(std::move(r));
        return all;
    }();
    return rows;
}

void apply_setting(Settings& settings, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    require(equals != std::string::npos, "--set " + assignment + ": expected name=value",
            ExitCode::usage);
    const std::string name = assignment.substr(0, equals);
    std::vector<std::string> names;
    for (const SettingRow& r : setting_rows()) {
        if (r.name == name) {
            r.set(settings, assignment.substr(equals + 1));
            return;
        }
        names.push_back(r.name);
    }
    throw Error(ExitCode::usage, "--set " + assignment + ": there is no setting '" + name +
                                     "'; did you mean '" + nearest_word(name, names) + "'?");
}

}  // namespace inlay
