// JsonNode: a JSON document as a value that knows where it stands, and readers that refuse with
// that place in the message.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace inlay {

struct JsonNode {
    enum class Kind { null, boolean, number, text, array, object };
    Kind kind = Kind::null;
    std::string place;  // file and path within it: "scene.json: objects[1].sphere.radius"
    bool boolean = false;
    double number = 0;
    std::string text;
    std::vector<JsonNode> items;                            // of an array
    std::vector<std::pair<std::string, JsonNode>> members;  // of an object, by key
};

/// A closed interval that a number must lie in.
struct Range {
    double least = 0, greatest = 0;
};

/// Parses a file. Throws Error: input_missing; bad_data with line and column for bad syntax, a key
/// that occurs twice, nesting deeper than 32, or a file above 16 MiB.
JsonNode read_json(const std::filesystem::path& file);

/// Parses a text; `name` stands for the file in messages. Throws as read_json.
JsonNode parse_json(const std::string& text, const std::string& name);

/// Throws Error (bad_data): "<place>: found <found>; expected <expected>".
[[noreturn]] void refuse(const JsonNode& node, const std::string& found,
                         const std::string& expected);

/// The node in a few words, for messages.
std::string describe(const JsonNode& node);

/// The member called `key`, or nullptr. Throws unless `node` is an object.
const JsonNode* find(const JsonNode& node, const std::string& key);

/// The member called `key`. Throws where it is missing.
const JsonNode& member(const JsonNode& node, const std::string& key);

/// Throws unless `node` is an object whose keys are all in `known`; names the nearest known key.
void require_known_keys(const JsonNode& node, const std::vector<std::string>& known);

/// The node's value. Throw where it is of another type, not finite, or outside its range.
double number_of(const JsonNode& node, const Range& range);
int integer_of(const JsonNode& node, const Range& range);
bool boolean_of(const JsonNode& node);
const std::string& text_of(const JsonNode& node);
const std::vector<JsonNode>& items_of(const JsonNode& node);

/// Exactly `count` numbers.
std::vector<double> numbers_of(const JsonNode& node, std::size_t count, const Range& range);

/// One of `words`; names the nearest one where it is none of them.
const std::string& word_of(const JsonNode& node, const std::vector<std::string>& words);

}  // namespace inlay
