// Settings: every choice of every stage in one value, each with a name for the command line.
#pragma once

#include "composite/blend/differential.h"
#include "render/filter/filter_settings.h"
#include "render/trace/depth_pyramid.h"
#include "render/trace/two_mode_sampler.h"
#include "slam/mapping/advance_slam.h"

#include <functional>
#include <string>
#include <vector>

namespace inlay {

/// What rays that leave a real surface meet of the real scene.
enum class RealGeometryKind {
    screen,  // this frame's surface map, marched in image space
    map,     // this frame's surface map, triangulated
    model    // the fused model, triangulated
};

struct GeometrySettings {
    RealGeometryKind kind = RealGeometryKind::model;
    float offset = 0.01f;                // m, distance from a real surface at which its rays start,
                                         // for every kind
    float visibility_tolerance = 0.05f;  // m, within which the photograph sees a point of the model
    float max_step = 0.05f;              // share of depth; steeper steps of the map are not joined
    int model_interval = 10;             // frames between two extractions of the model, >= 1
    ScreenTracerSettings screen;         // its own offset has no meaning here
};

/// The settings of RealGeometryKind::screen, with the offset that all kinds share.
ScreenTracerSettings screen_settings(const GeometrySettings& geometry);

struct Settings {
    SlamSettings slam;
    bool use_recorded_poses = false;
    GeometrySettings geometry;
    SamplingSettings trace{.estimator = Estimator::difference, .depth_tolerance = 0.004f};
    FilterSettings filter{.real_curvature = false};  // eq. 6.2 takes real irradiances as a ratio
    BlendSettings blend;
    bool skip = true;  // E_R only where the composite shows it: the same bytes for less work
};

/// Throws Error (usage) that names a setting which is out of range.
void validate(const Settings& settings);

/// A setting as the command line sees it.
struct SettingRow {
    std::string name;  // as in --set name=value
    std::string unit;  // or the words it takes
    std::function<std::string(const Settings&)> get;
    std::function<void(Settings&, const std::string&)> set;  // throws Error (usage)
};

const std::vector<SettingRow>& setting_rows();

/// The words that a setting takes, as "on" and "off"; none for a number. Throws Error (usage) that
/// names the nearest known setting.
std::vector<std::string> setting_words(const std::string& name);

/// Applies "name=value". Throws Error (usage) that names the nearest known setting.
void apply_setting(Settings& settings, const std::string& assignment);

}  // namespace inlay
