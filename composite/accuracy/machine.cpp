#include "composite/accuracy/machine.h"

#include "recordings/base/check.h"

#include <nlohmann/json.hpp>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <thread>

namespace inlay {
namespace {

std::string cpu_name() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        const std::size_t colon = line.find(": ");
        if (line.rfind("model name", 0) == 0 && colon != std::string::npos)
            return line.substr(colon + 2);
    }
    return "unknown";
}

std::string system_name() {
    utsname names{};
    if (uname(&names) != 0) return "unknown";
    return std::string(names.sysname) + " " + names.release + " " + names.machine;
}

}  // namespace

Machine this_machine() {
    constexpr double gib = 1024.0 * 1024.0 * 1024.0;
    return {cpu_name(), int(std::thread::hardware_concurrency()),
            double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) / gib, system_name(),
            "gcc " __VERSION__};
}

std::string to_json_text(const Machine& m) {
    return nlohmann::ordered_json{{"cpu", m.cpu},
                                  {"threads", m.threads},
                                  {"memory_gib", m.memory_gib},
                                  {"system", m.system},
                                  {"compiler", m.compiler}}
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Machine machine_from_json(const std::string& text, const std::string& place) {
    try {
        const auto json = nlohmann::json::parse(text);
        return {json.at("cpu"), json.at("threads"), json.at("memory_gib"), json.at("system"),
                json.at("compiler")};
    } catch (const nlohmann::json::exception& error) {
        throw Error(ExitCode::bad_data, place + ": not a description of a machine (" +
                                            error.what() + "); choose another --out");
    }
}

std::string utc_now() {
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

}  // namespace inlay
