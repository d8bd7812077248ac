// The README claims what was measured: its figures are lines and numbers of the summary that
// `inlay accuracy` wrote.
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace inlay {
namespace {

const std::string begin_mark = "<!-- figures of apps/report/accuracy_summary.md -->";
const std::string end_mark = "<!-- end of figures -->";

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<std::string> numbers_in(const std::string& text) {
    static const std::regex number(R"(\d+(\.\d+)?)");
    return {std::sregex_token_iterator(text.begin(), text.end(), number), {}};
}

/// Rows of tables that are no row of the summary, and numbers elsewhere that it does not have.
std::vector<std::string> not_in(const std::string& summary, const std::string& quoted) {
    const auto lines = lines_of(summary), numbers = numbers_in(summary);
    const std::set<std::string> known_lines(lines.begin(), lines.end());
    const std::set<std::string> known_numbers(numbers.begin(), numbers.end());
    std::vector<std::string> unknown;
    for (const std::string& line : lines_of(quoted)) {
        if (line.starts_with("|")) {
            if (!known_lines.contains(line)) unknown.push_back(line);
            continue;
        }
        for (const std::string& number : numbers_in(line))
            if (!known_numbers.contains(number)) unknown.push_back(number);
    }
    return unknown;
}

TEST(ReadmeFigures, StandInTheSummary) {
    const std::string root = INLAY_SOURCE_DIR;
    const std::string readme = test::file_text(root + "/README.md");
    const std::string summary = test::file_text(root + "/apps/report/accuracy_summary.md");
    ASSERT_NE(summary, "") << "apps/report/accuracy_summary.md is missing";
    int quotes = 0;
    for (std::size_t at = readme.find(begin_mark); at != std::string::npos;
         at = readme.find(begin_mark, at + 1)) {
        const std::size_t end = readme.find(end_mark, at);
        ASSERT_NE(end, std::string::npos) << "README.md lacks: " << end_mark;
        const std::size_t begin = at + begin_mark.size();
        const std::string quoted = readme.substr(begin, end - begin);
        EXPECT_FALSE(numbers_in(quoted).empty()) << "nothing is quoted";
        for (const std::string& unknown : not_in(summary, quoted))
            ADD_FAILURE() << "README.md quotes what the summary does not say: " << unknown;
        ++quotes;
    }
    EXPECT_GT(quotes, 0) << "README.md lacks: " << begin_mark;
}

TEST(ReadmeFigures, AChangedFigureIsFound) {
    const std::string summary = "Took 3.2 s.\n| desk | 0.0050 | 12.8 |\n| room | 0.0070 | 2.5 |\n";
    EXPECT_EQ(not_in(summary, "| desk | 0.0050 | 12.8 |\nthat is 12.8 in 3.2 s"),
              std::vector<std::string>{});
    EXPECT_EQ(not_in(summary, "| desk | 0.0050 | 2.5 |"),  // another row's figure
              std::vector<std::string>{"| desk | 0.0050 | 2.5 |"});
    EXPECT_EQ(not_in(summary, "2.8 times, 3 s"), (std::vector<std::string>{"2.8", "3"}));
}

}  // namespace
}  // namespace inlay
