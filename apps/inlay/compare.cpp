// `inlay compare`: how far pictures are from their references, two files or two folders of them.
#include "composite/measure/picture_file.h"
#include "recordings/base/check.h"

#include "apps/inlay/command.h"
#include "apps/inlay/options.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CompareOptions {
    CommonOptions common;
    std::string picture, reference;
};

/// What is compared with what, and what has no counterpart.
struct Pairs {
    struct Pair {
        std::string name;
        fs::path picture, reference;
    };
    std::vector<Pair> pairs;
    std::vector<std::string> only_in_a, only_in_b;
};

struct Row {
    std::string name;
    PictureError error;
};

/// The frame number that a file name ends with, before its extension.
std::optional<int> frame_number(const fs::path& name) {
    const std::string stem = name.stem().string();
    const std::size_t last_other = stem.find_last_not_of("0123456789");
    const std::size_t first = last_other == std::string::npos ? 0 : last_other + 1;
    int number = 0;
    const auto [end, error] =
        std::from_chars(stem.data() + first, stem.data() + stem.size(), number);
    if (error != std::errc()) return std::nullopt;
    return number;
}

std::vector<std::string> picture_names(const fs::path& folder, const FrameList& frames) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const fs::path name = entry.path().filename();
        if (!entry.is_regular_file() || !is_picture_name(name) || name.string()[0] == '.') continue;
        const std::optional<int> number = frame_number(name);
        if (frames.ranges.empty() || (number && frames.contains(*number)))
            names.push_back(name.string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::vector<std::string> without(const std::vector<std::string>& names,
                                 const std::vector<std::string>& others) {
    std::vector<std::string> rest;
    std::set_difference(names.begin(), names.end(), others.begin(), others.end(),
                        std::back_inserter(rest));
    return rest;
}

Pairs folder_pairs(const fs::path& a, const fs::path& b, const FrameList& frames) {
    const std::vector<std::string> names_a = picture_names(a, frames);
    const std::vector<std::string> names_b = picture_names(b, frames);
    Pairs result{{}, without(names_a, names_b), without(names_b, names_a)};
    for (const std::string& name : names_a)
        if (std::binary_search(names_b.begin(), names_b.end(), name))
            result.pairs.push_back({name, a / name, b / name});
    require(!result.pairs.empty(),
            a.string() + " and " + b.string() +
                ": no picture has the same file name in both; found " +
                std::to_string(names_a.size()) + " and " + std::to_string(names_b.size()) +
                " pictures, for instance OUT/frames and OTHER/frames would match",
            ExitCode::input_missing);
    return result;
}

Pairs find_pairs(const CompareOptions& options) {
    const fs::path a = options.picture;
    const fs::path b = options.reference;
    for (const fs::path& path : {a, b})
        require(fs::exists(path), path.string() + ": there is no such file or folder",
                ExitCode::input_missing);
    require(fs::is_directory(a) == fs::is_directory(b),
            a.string() + " and " + b.string() +
                ": one is a folder and the other a file; compare two of a kind",
            ExitCode::usage);
    const FrameList frames = parse_frames(options.common.frames);
    if (fs::is_directory(a)) return folder_pairs(a, b, frames);
    return {{{a.filename().string(), a, b}}, {}, {}};
}

Row compare(const Pairs::Pair& pair) {
    try {
        return {pair.name, picture_error(read_picture(pair.picture), read_picture(pair.reference))};
    } catch (const Error& error) {
        const std::string message = error.what();
        if (message.find(pair.name) != std::string::npos) throw;
        throw Error(error.code(),
                    pair.picture.string() + " and " + pair.reference.string() + ": " + message);
    }
}

double mean_square(double psnr) { return std::pow(10.0, -psnr / 10); }

/// Means over the rows; of PSNR that of the mean squared difference, since equal pictures have an
/// infinite one. `pixels` and `non_finite` are sums.
PictureError mean_of(const std::vector<Row>& rows) {
    PictureError mean;
    mean.display.ssim = 0;
    double square = 0;
    const double share = 1.0 / double(rows.size());
    for (const Row& row : rows) {
        const PictureError& e = row.error;
        mean.radiance.rmse += share * e.radiance.rmse;
        mean.radiance.relative_rmse += share * e.radiance.relative_rmse;
        mean.radiance.pixels += e.radiance.pixels;
        mean.radiance.non_finite += e.radiance.non_finite;
        mean.display.ssim += share * e.display.ssim;
        mean.display.flip += share * e.display.flip;
        square += share * mean_square(e.display.psnr);
    }
    mean.display.psnr = -10 * std::log10(square);
    return mean;
}

void print_row(const std::string& name, const PictureError& e, int width) {
    std::cout << fmt::format("{:<{}} {:>11.4g} {:>11.4g} {:>9.2f} {:>9.5f} {:>9.5f} {:>10}\n", name,
                             width, e.radiance.rmse, e.radiance.relative_rmse, e.display.psnr,
                             e.display.ssim, e.display.flip, e.radiance.non_finite);
}

void print_text(const Pairs& pairs, const std::vector<Row>& rows) {
    int width = 4;
    for (const Row& row : rows)
        width = std::max(width, int(row.name.size()));
    std::cout << fmt::format("{:<{}} {:>11} {:>11} {:>9} {:>9} {:>9} {:>10}\n", "name", width,
                             "RMSE", "relative", "PSNR/dB", "SSIM", "FLIP", "not finite");
    for (const Row& row : rows)
        print_row(row.name, row.error, width);
    if (rows.size() > 1) print_row("mean", mean_of(rows), width);
    for (const std::string& name : pairs.only_in_a)
        std::cout << "only in A: " << name << "\n";
    for (const std::string& name : pairs.only_in_b)
        std::cout << "only in B: " << name << "\n";
}

/// Infinite figures become null.
Json to_json(const PictureError& e) {
    return {{"rmse", e.radiance.rmse},
            {"relative_rmse", e.radiance.relative_rmse},
            {"psnr_db", e.display.psnr},
            {"ssim", e.display.ssim},
            {"flip", e.display.flip},
            {"pixels", e.radiance.pixels},
            {"non_finite", e.radiance.non_finite}};
}

void print_json(const Pairs& pairs, const std::vector<Row>& rows) {
    Json list = Json::array();
    for (const Row& row : rows) {
        Json item{{"name", row.name}};
        item.update(to_json(row.error));
        list.push_back(std::move(item));
    }
    const Json json{{"pairs", list},
                    {"mean", to_json(mean_of(rows))},
                    {"only_in_a", pairs.only_in_a},
                    {"only_in_b", pairs.only_in_b}};
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

int run(const CompareOptions& options) {
    apply(options.common);
    const Pairs pairs = find_pairs(options);
    std::vector<Row> rows;
    for (const Pairs::Pair& pair : pairs.pairs)
        rows.push_back(compare(pair));
    if (options.common.json)
        print_json(pairs, rows);
    else
        print_text(pairs, rows);
    const std::uint64_t non_finite = mean_of(rows).radiance.non_finite;
    if (non_finite > 0) spdlog::warn("{} pixels are not finite and were left out", non_finite);
    return int(ExitCode::done);
}

}  // namespace

std::function<int()> add_compare(CLI::App& subcommand) {
    const auto options = std::make_shared<CompareOptions>();
    subcommand
        .add_option("A", options->picture, "A picture (.png, .jpg, .exr, .hdr) or a folder of them")
        ->required();
    subcommand.add_option("B", options->reference, "Its reference; files of folders pair by name")
        ->required();
    add_common_options(subcommand, options->common);
    return [options] { return run(*options); };
}

}  // namespace inlay
