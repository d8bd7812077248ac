// How rows of settings are made: names bound to members. For the sources of this folder only.
#pragma once

#include "composite/session/settings.h"
#include "recordings/base/check.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace inlay {

std::vector<SettingRow> slam_rows();
std::vector<SettingRow> render_rows();

template <class Enum>
using Words = std::vector<std::pair<const char*, Enum>>;

[[noreturn]] inline void refuse_setting(const std::string& name, const std::string& value,
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
    if (!good)
        refuse_setting(name, text, std::is_integral_v<Number> ? "a whole number" : "a number");
    value = parsed;
}

inline void read_value(const std::string& name, const std::string& text, bool& value) {
    if (text != "on" && text != "off") refuse_setting(name, text, "on or off");
    value = text == "on";
}

template <class Number>
std::string written(Number value) {
    std::array<char, 32> buffer{};
    const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return {buffer.data(), result.ptr};
}

inline std::string written(bool value) { return value ? "on" : "off"; }

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
                refuse_setting(name, text, list);
            }};
}

/// How a row reaches its setting, const or not.
#define INLAY_MEMBER(path) \
    [](auto& s) -> auto& { return s.path; }

}  // namespace inlay
