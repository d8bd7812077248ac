#include "recordings/readers/text_file.h"

#include "recordings/base/check.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <system_error>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t text_limit = 256u << 20;  // bytes; no list of frames comes near
constexpr std::int64_t latest_ns = 4'000'000'000'000'000'000;  // differences of two stamps fit

std::string last_failure() { return std::generic_category().message(errno); }

std::vector<TextLine> all_lines(const fs::path& file) {
    std::istringstream stream(read_bytes(file, text_limit));
    std::vector<TextLine> lines;
    for (TextLine line{1, {}}; std::getline(stream, line.text); ++line.number) {
        if (line.number == 1 && line.text.starts_with("\xEF\xBB\xBF")) line.text.erase(0, 3);
        while (!line.text.empty() && std::strchr(" \t\r", line.text.back()) && line.text.back())
            line.text.pop_back();
        lines.push_back(line);
    }
    return lines;
}

bool comment(const TextLine& line) {
    const std::size_t first = line.text.find_first_not_of(" \t");
    return first != std::string::npos && line.text[first] == '#';
}

void write_all(int descriptor, std::string_view text, const fs::path& file) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        require(written >= 0, file.string() + ": cannot write: " + last_failure(),
                ExitCode::disk_fault);
        text.remove_prefix(std::size_t(written));
    }
}

}  // namespace

std::string read_bytes(const fs::path& file, std::uintmax_t limit) {
    std::error_code error;
    require(fs::exists(file, error), file.string() + ": no such file", ExitCode::input_missing);
    require(fs::is_regular_file(file, error), file.string() + ": not a regular file");
    const std::uintmax_t size = fs::file_size(file, error);
    require(!error, file.string() + ": cannot be read: " + error.message());
    require(size <= limit, file.string() + ": has " + std::to_string(size) +
                               " bytes, expected at most " + std::to_string(limit));
    std::ifstream stream(file, std::ios::binary);
    require(stream.good(), file.string() + ": cannot be opened: " + last_failure());
    std::string bytes(std::size_t(size), '\0');
    stream.read(bytes.data(), std::streamsize(size));
    require(stream.gcount() == std::streamsize(size),
            file.string() + ": cannot be read to its end");
    return bytes;
}

std::vector<TextLine> read_lines(const fs::path& file) {
    std::vector<TextLine> lines = all_lines(file);
    std::erase_if(lines, [](const TextLine& line) { return line.text.empty() || comment(line); });
    return lines;
}

std::vector<std::string> read_comments(const fs::path& file) {
    std::vector<std::string> comments;
    for (const TextLine& line : all_lines(file))
        if (comment(line)) comments.push_back(line.text);
    return comments;
}

std::vector<std::string_view> words(std::string_view text) {
    constexpr std::string_view separators = " \t,\r\n";
    std::vector<std::string_view> result;
    std::size_t begin = text.find_first_not_of(separators);
    while (begin != std::string_view::npos) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        result.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return result;
}

std::optional<double> parse_number(std::string_view word) {
    for (const char* not_a_number : {"#IND", "#QNAN", "#INF"})
        if (word.find(not_a_number) != std::string_view::npos)
            return std::numeric_limits<double>::quiet_NaN();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

std::optional<std::int64_t> parse_time_ns(std::string_view word) {
    const bool negative = word.starts_with('-');
    if (negative) word.remove_prefix(1);
    const std::size_t point = std::min(word.find('.'), word.size());
    const std::string_view whole = word.substr(0, point);
    std::string fraction(word.substr(std::min(point + 1, word.size())));
    if (whole.size() + fraction.size() == 0 || whole.size() > 9 + 1) return std::nullopt;
    for (const std::string_view part : {whole, std::string_view(fraction)})
        if (part.find_first_not_of("0123456789") != std::string_view::npos) return std::nullopt;
    fraction.resize(9, '0');
    const std::string digits = std::string(whole) + fraction;
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    if (value > latest_ns) return std::nullopt;
    return negative ? -value : value;
}

std::vector<double> parse_numbers(const fs::path& file, const TextLine& line, std::size_t count) {
    const auto found = words(line.text);
    if (found.size() != count) fail_at(file, line, std::to_string(count) + " numbers");
    std::vector<double> numbers;
    for (const std::string_view word : found) {
        const std::optional<double> number = parse_number(word);
        if (!number) fail_at(file, line, std::to_string(count) + " numbers");
        numbers.push_back(*number);
    }
    return numbers;
}

void fail_at(const fs::path& file, const TextLine& line, const std::string& expected) {
    throw Error(ExitCode::bad_data, file.string() + ":" + std::to_string(line.number) +
                                        ": found '" + printable(line.text) + "', expected " +
                                        expected);
}

std::string printable(std::string_view text) {
    std::string result(text.substr(0, 60));
    for (char& c : result)
        if (c < 0x20 || c > 0x7e) c = '?';
    return text.size() > 60 ? result + "..." : result;
}

void write_text(const fs::path& file, std::string_view text) {
    const fs::path beside = file.string() + ".partial";
    const int descriptor = ::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    require(descriptor >= 0, beside.string() + ": cannot be created: " + last_failure(),
            ExitCode::cannot_create);
    try {
        write_all(descriptor, text, beside);
        require(::fsync(descriptor) == 0, beside.string() + ": cannot be synced",
                ExitCode::disk_fault);
    } catch (...) {
        ::close(descriptor);
        ::unlink(beside.c_str());
        throw;
    }
    ::close(descriptor);
    std::error_code error;
    fs::rename(beside, file, error);
    if (error) ::unlink(beside.c_str());
    require(!error, file.string() + ": cannot be replaced: " + error.message(),
            ExitCode::cannot_create);
}

}  // namespace inlay
