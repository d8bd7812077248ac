// Text files as lines and numbers, with messages that name the file and the line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace inlay {

struct TextLine {
    int number = 0;  // in the file, from 1
    std::string text;
};

/// A file's bytes. Throws Error: input_missing where there is no such file, bad_data where it
/// cannot be read or is larger than `limit` bytes.
std::string read_bytes(const std::filesystem::path& file, std::uintmax_t limit);

/// The lines of a file that are neither blank nor comments (`#`), without line ends. Throws as
/// read_bytes.
std::vector<TextLine> read_lines(const std::filesystem::path& file);

/// The file's comment lines (`#`), for what data sets write into them. Throws as read_bytes.
std::vector<std::string> read_comments(const std::filesystem::path& file);

/// The words of a line: separated by white space or commas.
std::vector<std::string_view> words(std::string_view text);

/// A number, which may be NaN or infinite in any of the usual spellings; empty if it is none.
std::optional<double> parse_number(std::string_view word);

/// Seconds written as a plain decimal ("1305031233.525708") in ns, without the detour over a
/// double, which has no digits left for it; empty if it is none or does not fit.
std::optional<std::int64_t> parse_time_ns(std::string_view word);

/// All words of a line as numbers. Throws Error (bad_data) unless there are `count` of them.
std::vector<double> parse_numbers(const std::filesystem::path& file, const TextLine& line,
                                  std::size_t count);

/// Throws Error (bad_data): "file:line: found '...', expected ...".
[[noreturn]] void fail_at(const std::filesystem::path& file, const TextLine& line,
                          const std::string& expected);

/// Found text as a message may show it: unprintable characters replaced, and cut to 60.
std::string printable(std::string_view text);

/// Writes a file that appears under its name only when it is complete. Throws Error:
/// cannot_create, or disk_fault when the disk is full or fails.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace inlay
