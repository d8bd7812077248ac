#include "render/scene/json_node.h"

#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

namespace inlay {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::uintmax_t max_bytes = 16u << 20;
constexpr int max_depth = 32;

std::string line_and_column(const std::string& text, std::size_t byte) {
    const std::size_t at = std::min(byte > 0 ? byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
    const std::size_t start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = start == std::string::npos ? at + 1 : at - start;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// nlohmann keeps the last of two equal keys and follows any depth; both are refused here.
class Guard {
public:
    explicit Guard(std::string name) : name_(std::move(name)) {}

    bool operator()(int depth, json::parse_event_t event, json& parsed) {
        require(depth <= max_depth, name_ + ": nested deeper than " + std::to_string(max_depth) +
                                        " levels; expected a scene description");
        if (event == json::parse_event_t::object_start) keys_.emplace_back();
        if (event == json::parse_event_t::object_end) keys_.pop_back();
        if (event == json::parse_event_t::key) {
            const auto key = parsed.get<std::string>();
            require(keys_.back().insert(key).second,
                    name_ + ": the key \"" + key + "\" occurs twice in one object; remove one");
        }
        return true;
    }

private:
    std::string name_;
    std::vector<std::set<std::string>> keys_;
};

JsonNode convert(const json& value, const std::string& name, const std::string& path) {
    JsonNode node;
    node.place = name + ": " + (path.empty() ? "the document" : path);
    if (value.is_boolean()) {
        node.kind = JsonNode::Kind::boolean;
        node.boolean = value.get<bool>();
    } else if (value.is_number()) {
        node.kind = JsonNode::Kind::number;
        node.number = value.get<double>();
    } else if (value.is_string()) {
        node.kind = JsonNode::Kind::text;
        node.text = value.get<std::string>();
    } else if (value.is_array()) {
        node.kind = JsonNode::Kind::array;
        for (std::size_t i = 0; i < value.size(); ++i)
            node.items.push_back(convert(value[i], name, path + "[" + std::to_string(i) + "]"));
    } else if (value.is_object()) {
        node.kind = JsonNode::Kind::object;
        for (const auto& [key, item] : value.items())
            node.members.emplace_back(key,
                                      convert(item, name, path.empty() ? key : path + "." + key));
    }
    return node;
}

std::string number_text(double v) {
    std::ostringstream stream;
    stream.precision(8);
    stream << v;
    return stream.str();
}

std::string range_text(const Range& r) {
    return number_text(r.least) + " to " + number_text(r.greatest);
}

std::string list_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "\"" : ", \"") + word + "\"";
    return text;
}

}  // namespace

JsonNode parse_json(const std::string& text, const std::string& name) {
    try {
        Guard guard(name);
        const json document =
            json::parse(text, [&](int depth, json::parse_event_t event, json& parsed) {
                return guard(depth, event, parsed);
            });
        return convert(document, name, "");
    } catch (const json::parse_error& fault) {
        throw Error(ExitCode::bad_data, name + ": " + line_and_column(text, fault.byte) +
                                            ": not valid JSON; check commas, quotes and brackets"
                                            " there (" +
                                            fault.what() + ")");
    } catch (const json::exception& fault) {
        throw Error(ExitCode::bad_data,
                    name + ": not valid JSON or a number out of range (" + fault.what() + ")");
    }
}

JsonNode read_json(const fs::path& file) {
    std::error_code ignored;
    require(fs::is_regular_file(file, ignored), file.string() + ": no such file",
            ExitCode::input_missing);
    require(fs::file_size(file, ignored) <= max_bytes,
            file.string() + ": larger than 16 MiB; expected a scene description");
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    require(bool(stream), file.string() + ": cannot be read; check its permissions",
            ExitCode::input_missing);
    return parse_json(text.str(), file.string());
}

void refuse(const JsonNode& node, const std::string& found, const std::string& expected) {
    throw Error(ExitCode::bad_data, node.place + ": found " + found + "; expected " + expected);
}

std::string describe(const JsonNode& node) {
    switch (node.kind) {
        case JsonNode::Kind::null:
            return "null";
        case JsonNode::Kind::boolean:
            return node.boolean ? "true" : "false";
        case JsonNode::Kind::number:
            return number_text(node.number);
        case JsonNode::Kind::text:
            return "\"" + node.text.substr(0, 60) + "\"";
        case JsonNode::Kind::array:
            return "an array of " + std::to_string(node.items.size());
        case JsonNode::Kind::object:
            return "an object";
    }
    return "";
}

const JsonNode* find(const JsonNode& node, const std::string& key) {
    if (node.kind != JsonNode::Kind::object) refuse(node, describe(node), "an object {...}");
    for (const auto& [name, value] : node.members)
        if (name == key) return &value;
    return nullptr;
}

const JsonNode& member(const JsonNode& node, const std::string& key) {
    const JsonNode* found = find(node, key);
    if (!found) refuse(node, "no \"" + key + "\"", "the key \"" + key + "\"");
    return *found;
}

void require_known_keys(const JsonNode& node, const std::vector<std::string>& known) {
    if (node.kind != JsonNode::Kind::object) refuse(node, describe(node), "an object {...}");
    for (const auto& [key, value] : node.members) {
        if (std::find(known.begin(), known.end(), key) != known.end()) continue;
        throw Error(ExitCode::bad_data, value.place + ": unknown key \"" + key.substr(0, 60) +
                                            "\"; did you mean \"" + nearest_word(key, known) +
                                            "\"? Expected: " + list_text(known));
    }
}

double number_of(const JsonNode& node, const Range& range) {
    if (node.kind != JsonNode::Kind::number)
        refuse(node, describe(node), "a number, " + range_text(range));
    if (!std::isfinite(node.number) || node.number < range.least || node.number > range.greatest)
        refuse(node, describe(node), range_text(range));
    return node.number;
}

int integer_of(const JsonNode& node, const Range& range) {
    const double value = number_of(node, range);
    if (value != std::floor(value)) refuse(node, describe(node), "a whole number");
    return int(value);
}

bool boolean_of(const JsonNode& node) {
    if (node.kind != JsonNode::Kind::boolean) refuse(node, describe(node), "true or false");
    return node.boolean;
}

const std::string& text_of(const JsonNode& node) {
    if (node.kind != JsonNode::Kind::text) refuse(node, describe(node), "a text in quotes");
    return node.text;
}

const std::vector<JsonNode>& items_of(const JsonNode& node) {
    if (node.kind != JsonNode::Kind::array) refuse(node, describe(node), "an array [...]");
    return node.items;
}

std::vector<double> numbers_of(const JsonNode& node, std::size_t count, const Range& range) {
    if (node.kind != JsonNode::Kind::array || node.items.size() != count)
        refuse(node, describe(node), "an array of " + std::to_string(count) + " numbers");
    std::vector<double> numbers;
    for (const JsonNode& item : node.items)
        numbers.push_back(number_of(item, range));
    return numbers;
}

const std::string& word_of(const JsonNode& node, const std::vector<std::string>& words) {
    const std::string& word = text_of(node);
    if (std::find(words.begin(), words.end(), word) == words.end())
        refuse(node, describe(node),
               "one of " + list_text(words) + " (nearest: \"" + nearest_word(word, words) + "\")");
    return word;
}

}  // namespace inlay
