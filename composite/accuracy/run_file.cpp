#include "composite/accuracy/run_file.h"

#include "composite/accuracy/judged_frames.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

#include <ctime>
#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

ordered_json json_of(const Machine& m) {
    return {{"cpu", m.cpu},
            {"threads", m.threads},
            {"memory_gib", m.memory_gib},
            {"system", m.system},
            {"compiler", m.compiler}};
}

Machine machine_from(const ordered_json& json) {
    return {json.at("cpu"), json.at("threads"), json.at("memory_gib"), json.at("system"),
            json.at("compiler")};
}

/// What must be the same for a run to go on.
ordered_json identity(const std::vector<Work>& works, const BenchOptions& options) {
    ordered_json settings;
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(options.settings);
    ordered_json json{
        {"program", options.program},    {"settings", settings},
        {"repeats", options.repeats},    {"quick", options.quick},
        {"only", options.only},          {"converged_samples", options.converged_samples},
        {"works", ordered_json::array()}};
    for (const Work& work : works)
        json["works"].push_back({{"name", work.name},
                                 {"source", fs::absolute(work.source).string()},
                                 {"frames", measured_frames(work, options.wanted_frame)}});
    return json;
}

void require_same(const ordered_json& kept, const ordered_json& now, const fs::path& file) {
    for (const auto& [key, value] : now.items()) {
        require(kept.contains(key) && kept.at(key) == value,
                file.string() + ": the run that this folder holds has another '" + key +
                    "'; repeat its command, or choose another --out",
                ExitCode::usage);
    }
}

}  // namespace

RunFacts open_run(const std::vector<Work>& works, const BenchOptions& options,
                  const fs::path& folder) {
    const fs::path file = folder / "run.json";
    const ordered_json now = identity(works, options);
    if (!fs::exists(file)) {
        const RunFacts facts{utc_now(), this_machine()};
        ordered_json json{{"date", facts.date}, {"machine", json_of(facts.machine)}};
        json["run"] = now;
        write_text(file, json.dump(1) + "\n");
        return facts;
    }
    require(options.resume,
            folder.string() + ": holds a run already; go on with --resume, or choose another --out",
            ExitCode::usage);
    std::ifstream stream(file);
    const ordered_json kept = ordered_json::parse(stream, nullptr, /*allow_exceptions=*/false);
    require(!kept.is_discarded() && kept.contains("run") && kept.contains("date") &&
                kept.contains("machine"),
            file.string() + ": damaged; expected what a run writes; choose another --out");
    require_same(kept.at("run"), now, file);
    return {kept.at("date"), machine_from(kept.at("machine"))};
}

}  // namespace inlay
