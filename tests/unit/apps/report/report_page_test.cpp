// The report page: its data cannot break it, and in a browser it shows what the data says.
#include "apps/report/report_page.h"

#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <string>

namespace {

using inlay::report_page;
using inlay::test::file_text;
using inlay::test::TemporaryFolder;

/// What a browser takes for the data: all between the element's tags.
std::string data_of(const std::string& page) {
    const std::string open = R"(<script type="application/json" id="data">)";
    const std::size_t begin = page.find(open) + open.size();
    return page.substr(begin, page.find("</script>", begin) - begin);
}

TEST(ReportPage, KeepsEveryTextOfTheDataAndIsNotEndedByIt) {
    const nlohmann::json data = {{"</script><script>alert(1)</script>", "<!--<script> ]]> -->"},
                                 {"line separators", "a\u2028b\u2029c"},
                                 {"their neighbours", "\u2027\u202A\xE2\x82\xAC"},
                                 {"marks", R"(&amp; \u003c ' " )inlay" $& /*data*/)"}};
    const std::string embedded = data_of(report_page(data.dump()));
    EXPECT_EQ(nlohmann::json::parse(embedded), data);
    EXPECT_EQ(embedded.find('<'), std::string::npos);
    EXPECT_EQ(embedded.find("\u2028"), std::string::npos);
    EXPECT_EQ(embedded.find("\u2029"), std::string::npos);
}

TEST(ReportPage, IsOneDocument) {
    const std::string page = report_page("{}");
    EXPECT_THAT(page, testing::StartsWith("<!doctype html>"));
    EXPECT_THAT(page, testing::HasSubstr("default-src 'none'"));  // a browser loads nothing for it
    EXPECT_THAT(page, testing::EndsWith("</html>\n"));
}

/// Runs a script of this folder with Node.js; returns what it printed, and fails where it fails.
std::string run_script(const std::string& arguments) {
    const TemporaryFolder folder;
    const std::string log = (folder / "log").string();
    const std::string scripts = INLAY_SOURCE_DIR "/tests/unit/apps/report/";
    const std::string line = INLAY_NODE " " + scripts + arguments + " >" + log + " 2>&1 </dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << "needs the packages nodejs and chromium\n"
                                            << file_text(log);
    return file_text(log);
}

std::string written_page(const TemporaryFolder& folder, const std::string& name,
                         const std::string& json) {
    const std::string file = (folder / (name + ".html")).string();
    std::ofstream(file, std::ios::binary) << report_page(json);
    return file;
}

std::string sample_page(const TemporaryFolder& folder, const std::string& kind) {
    const std::string file = (folder / (kind + ".json")).string();
    run_script("write_sample.mjs " + kind + " " + file);
    return written_page(folder, kind, file_text(file));
}

/// One cell without most of its figures, of a method that is not listed.
constexpr const char* sparse_accuracy = R"({"version": 1, "methods": [], "works": [{
    "name": "one", "title": "One", "kind": "scene", "width": 8, "height": 6, "frames": [3],
    "environment_bandwidth": null, "fronts": {"rmse": ["a"], "flip": []}, "pictures": [],
    "equal_error": [], "equal_time": [], "blame": null, "estimate": null, "cells": [
      {"id": "a", "knob": "samples", "value": "1", "method": "m", "temporal": false, "samples": 1,
       "wall_ms": {"total": {"median": 3.5, "min": 3, "max": 4}}, "failed": null, "truth": null,
       "converged": {"rmse_influenced": 0.1, "flip": null},
       "frames": [{"frame": 3, "rmse_influenced": 0.1, "flip": null, "ms": null}]}]}]})";

TEST(ReportPage, ShowsItsDataInABrowser) {
    const TemporaryFolder folder;
    const std::string log = run_script(
        "page_test.mjs accuracy " + sample_page(folder, "accuracy") + " replay " +
        sample_page(folder, "replay") + " render " + sample_page(folder, "render") + " sparse " +
        written_page(folder, "sparse_accuracy", sparse_accuracy) + " sparse " +
        written_page(folder, "sparse_replay", R"({"version": 1, "kind": "replay"})") + " refusal " +
        written_page(folder, "refusal", R"({"version": 2})"));
    EXPECT_THAT(log, testing::HasSubstr("ok      accuracy: nothingIsWrong"));
    EXPECT_THAT(log, testing::HasSubstr("ok      replay: nothingIsWrong"));
    EXPECT_THAT(log, testing::HasSubstr("ok      render: nothingIsWrong"));
    EXPECT_THAT(log, testing::HasSubstr("ok      refusal: saysWhyItShowsNothing"));
}

}  // namespace
