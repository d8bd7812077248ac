// Settings by name: every field of a stage has a row, and messages name rows that exist.
#include "composite/session/settings.h"

#include "recordings/base/check.h"

#include <gtest/gtest.h>

#include <cctype>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace inlay {
namespace {

std::vector<std::string> printed(const Settings& settings) {
    std::vector<std::string> lines;
    for (const SettingRow& row : setting_rows())
        lines.push_back(row.name + "=" + row.get(settings));
    return lines;
}

/// Whether `text` holds `name` as a whole, not as the beginning of another name.
bool names(const std::string& text, const std::string& name) {
    const auto part_of_name = [&](std::size_t i) {
        return i < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
    };
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1))
        if (!part_of_name(at + name.size())) return true;
    return false;
}

TEST(SettingRows, WhatIsOutOfRangeIsRefusedByItsName) {
    for (const SettingRow& row : setting_rows()) {
        Settings settings;
        try {
            row.set(settings, "-1");  // no setting takes it: words and switches refuse it as well
            validate(settings);
            ADD_FAILURE() << row.name << "=-1 was accepted";
        } catch (const Error& error) {
            EXPECT_TRUE(names(error.what(), row.name)) << row.name << ": " << error.what();
            EXPECT_EQ(error.code(), ExitCode::usage) << row.name;
        }
    }
}

TEST(SettingRows, EveryFieldOfSlamSettingsHasOne) {
    static_assert(std::is_trivially_copyable_v<SlamSettings> && sizeof(SlamSettings) % 4 == 0);
    const std::vector<std::string> before = printed({});
    for (std::size_t at = 0; at < sizeof(SlamSettings); at += 4) {  // all fields have 4 bytes
        Settings settings;
        auto* bytes = reinterpret_cast<unsigned char*>(&settings.slam);
        bytes[at] ^= 1;  // the lowest bit of a number
        EXPECT_NE(printed(settings), before) << "the field at byte " << at << " has no row";
    }
}

TEST(SettingRows, SayWhatFastSlamChanges) {
    Settings fast;
    fast.slam = fast_slam();
    Settings again;  // from the rows alone
    for (const SettingRow& row : setting_rows())
        row.set(again, row.get(fast));
    EXPECT_EQ(std::memcmp(&again.slam, &fast.slam, sizeof(SlamSettings)), 0);
    EXPECT_NE(printed(fast), printed({}));
}

TEST(SettingRows, WordsAreWhatTheSettingTakes) {
    EXPECT_EQ(setting_words("filter.enabled"), (std::vector<std::string>{"on", "off"}));
    EXPECT_EQ(setting_words("geometry.offset"), std::vector<std::string>{});
    int with_words = 0;
    for (const SettingRow& row : setting_rows()) {
        for (const std::string& word : setting_words(row.name)) {
            Settings settings;
            apply_setting(settings, row.name + "=" + word);
            EXPECT_EQ(row.get(settings), word) << row.name;
            ++with_words;
        }
    }
    EXPECT_GT(with_words, 10);
    EXPECT_THROW(setting_words("filter.constant"), Error);
}

TEST(Settings, RaysOfEveryKindOfGeometryStartAtOneOffset) {
    Settings settings;
    apply_setting(settings, "geometry.offset=0.02");
    EXPECT_EQ(screen_settings(settings.geometry).offset, 0.02f);
    EXPECT_EQ(screen_settings(settings.geometry).thickness, settings.geometry.screen.thickness);
}

}  // namespace
}  // namespace inlay
