#include "composite/write/frame_report.h"

#include "composite/write/atomic_file.h"
#include "composite/write/descriptor.h"
#include "recordings/base/check.h"

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>

namespace inlay {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

struct StatusName {
    TrackingStatus status;
    const char* name;
};
constexpr StatusName status_names[] = {{TrackingStatus::tracked, "tracked"},
                                       {TrackingStatus::weak, "weak"},
                                       {TrackingStatus::lost, "lost"}};

TrackingStatus status_from(const std::string& name, const std::string& place) {
    for (const StatusName& row : status_names)
        if (name == row.name) return row.status;
    throw Error(ExitCode::bad_data,
                place + ": tracking is \"" + name + "\", expected tracked, weak or lost");
}

Json to_json(const Pose& pose) {
    Json numbers = Json::array();
    const glm::dmat4 m = to_matrix(pose);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            numbers.push_back(m[column][row]);
    return numbers;
}

Pose pose_from(const Json& numbers, const std::string& place) {
    require(numbers.size() == 16, place + ": world_from_camera has " +
                                      std::to_string(numbers.size()) + " numbers, expected 16");
    glm::dmat4 m(1.0);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            m[column][row] = numbers.at(std::size_t(4 * row + column)).get<double>();
    return from_matrix(m);
}

Json to_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json to_json(const GovernedFrame& g) {
    return {{"samples", g.samples},
            {"expected_ms", to_json(g.expected_ms)},
            {"expected_error", to_json(g.expected_error)},
            {"estimated_error", to_json(g.estimated_error)},
            {"check_ms", g.check_ms}};
}

GovernedFrame governed_from(const Json& json) {
    const auto number = [&](const char* key) {
        const Json& value = json.at(key);
        return value.is_null() ? std::nullopt : std::optional(value.get<double>());
    };
    return {json.at("samples").get<int>(), number("expected_ms"), number("expected_error"),
            number("estimated_error"), json.at("check_ms").get<double>()};
}

std::string whole_text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    require(stream.is_open(), file.string() + ": cannot be opened for reading",
            ExitCode::input_missing);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Where the last complete line ends.
std::size_t complete_size(const std::string& text) {
    const std::size_t end = text.rfind('\n');
    return end == std::string::npos ? 0 : end + 1;
}

/// Cuts off what stands behind the last complete line.
void drop_unfinished_line(const Descriptor& out, const fs::path& file) {
    const off_t size = ::lseek(out.get(), 0, SEEK_END);
    char last = '\n';
    if (size > 0 && ::pread(out.get(), &last, 1, size - 1) != 1) throw_write_error(file, errno);
    if (last == '\n') return;
    if (::ftruncate(out.get(), off_t(complete_size(whole_text(file)))) != 0)
        throw_write_error(file, errno);
}

/// Writes all of `line` or nothing.
void write_at_end(const Descriptor& out, const std::string& line, const fs::path& file) {
    const off_t before = ::lseek(out.get(), 0, SEEK_END);
    for (std::size_t written = 0; written < line.size();) {
        const ssize_t count = ::write(out.get(), line.data() + written, line.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            const int error = errno;
            if (::ftruncate(out.get(), before) != 0) throw_write_error(file, errno);
            throw_write_error(file, error);
        }
        written += std::size_t(count);
    }
    if (::fsync(out.get()) != 0 && errno != EINVAL) throw_write_error(file, errno);
}

}  // namespace

const char* name_of(TrackingStatus status) {
    for (const StatusName& row : status_names)
        if (row.status == status) return row.name;
    return "";
}

std::string to_json_line(const FrameReport& r) {
    Json json{{"frame", r.frame},
              {"time_s", r.time},
              {"tracking", name_of(r.tracking)},
              {"world_from_camera", to_json(r.world_from_camera)},
              {"ms",
               {{"load", r.ms.load},
                {"slam", r.ms.slam},
                {"plan", r.ms.plan},
                {"trace", r.ms.trace},
                {"filter", r.ms.filter},
                {"composite", r.ms.composite},
                {"write", r.ms.write},
                {"total", r.ms.total}}},
              {"rays",
               {{"primary", r.rays.primary},
                {"virtual_shadow", r.rays.virtual_shadow},
                {"virtual_indirect", r.rays.virtual_indirect},
                {"real_shadow", r.rays.real_shadow},
                {"real_indirect", r.rays.real_indirect}}},
              {"pixels",
               {{"virtual", r.pixels.virtual_},
                {"influenced", r.pixels.influenced},
                {"skipped", r.pixels.skipped}}},
              {"dropped_samples", r.dropped_samples},
              {"replaced_pixels", r.replaced_pixels},
              {"plan", r.plan}};
    if (r.exposure != glm::vec3(1)) json["exposure"] = {r.exposure.r, r.exposure.g, r.exposure.b};
    if (r.governor) json["governor"] = to_json(*r.governor);
    return json.dump();
}

FrameReport from_json_line(const std::string& line, const std::string& place) {
    try {
        const Json json = Json::parse(line);
        const Json& ms = json.at("ms");
        const Json& rays = json.at("rays");
        const Json& pixels = json.at("pixels");
        const auto number = [&](const char* key) { return ms.at(key).get<double>(); };
        const auto count = [](const Json& counts, const char* key) {
            return counts.at(key).get<std::uint64_t>();
        };
        FrameReport r;
        r.frame = json.at("frame").get<int>();
        r.time = json.at("time_s").get<double>();
        r.tracking = status_from(json.at("tracking").get<std::string>(), place);
        r.world_from_camera = pose_from(json.at("world_from_camera"), place);
        if (json.contains("exposure")) {
            const auto exposure = json.at("exposure").get<std::array<float, 3>>();
            r.exposure = {exposure[0], exposure[1], exposure[2]};
        }
        r.ms = {number("load"),   number("slam"),      number("plan"),  number("trace"),
                number("filter"), number("composite"), number("write"), number("total")};
        r.rays = {count(rays, "primary"), count(rays, "virtual_shadow"),
                  count(rays, "virtual_indirect"), count(rays, "real_shadow"),
                  count(rays, "real_indirect")};
        r.pixels = {count(pixels, "virtual"), count(pixels, "influenced"),
                    count(pixels, "skipped")};
        r.dropped_samples = count(json, "dropped_samples");
        r.replaced_pixels = count(json, "replaced_pixels");
        r.plan = json.at("plan").get<std::vector<std::string>>();
        if (json.contains("governor")) r.governor = governed_from(json.at("governor"));
        return r;
    } catch (const nlohmann::json::exception& e) {
        throw Error(ExitCode::bad_data, place + ": is no frame report (" + e.what() +
                                            "): remove the line, or run without --resume");
    }
}

void append_report(const fs::path& file, const FrameReport& report) {
    const Descriptor out(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    if (!out.open()) throw_write_error(file, errno);
    drop_unfinished_line(out, file);
    write_at_end(out, to_json_line(report) + "\n", file);
}

std::vector<FrameReport> read_reports(const fs::path& file) {
    std::vector<FrameReport> reports;
    if (!fs::exists(file)) return reports;
    const std::string text = whole_text(file);
    const std::size_t end = complete_size(text);
    for (std::size_t start = 0; start < end;) {
        const std::size_t line_end = text.find('\n', start);
        const std::string place = file.string() + ", line " + std::to_string(reports.size() + 1);
        reports.push_back(from_json_line(text.substr(start, line_end - start), place));
        start = line_end + 1;
    }
    return reports;
}

}  // namespace inlay
