#include "composite/session/settings.h"

#include "composite/session/setting_rows.h"
#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"

#include <algorithm>
#include <utility>

namespace inlay {
namespace {

/// `place` says where the name was found, for the message.
const SettingRow& row_named(const std::string& name, const std::string& place) {
    std::vector<std::string> names;
    for (const SettingRow& r : setting_rows()) {
        if (r.name == name) return r;
        names.push_back(r.name);
    }
    throw Error(ExitCode::usage, place + ": there is no setting '" + name + "'; did you mean '" +
                                     nearest_word(name, names) + "'?");
}

}  // namespace

ScreenTracerSettings screen_settings(const GeometrySettings& geometry) {
    ScreenTracerSettings screen = geometry.screen;
    screen.offset = geometry.offset;
    return screen;
}

void validate(const Settings& s) {
    validate(s.slam);
    validate(s.trace);
    validate(s.filter);
    validate(s.blend);
    require(s.geometry.offset >= 0, "geometry.offset must not be negative", ExitCode::usage);
    validate(screen_settings(s.geometry));
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

std::vector<std::string> setting_words(const std::string& name) {
    const std::string& list = row_named(name, "settings").unit;
    std::vector<std::string> words;
    if (list.find('|') == std::string::npos) return words;
    for (std::size_t begin = 0; begin <= list.size();) {
        const std::size_t end = std::min(list.find('|', begin), list.size());
        words.push_back(list.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

void apply_setting(Settings& settings, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    require(equals != std::string::npos, "--set " + assignment + ": expected name=value",
            ExitCode::usage);
    const std::string name = assignment.substr(0, equals);
    row_named(name, "--set " + assignment).set(settings, assignment.substr(equals + 1));
}

}  // namespace inlay
