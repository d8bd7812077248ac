// The program `inlay`: a table of commands, and one place where failures become exit codes.
#include "recordings/base/check.h"
#include "recordings/base/keep_memory.h"

#include "apps/inlay/command.h"
#include "apps/inlay/invocation.h"
#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <utility>
#include <vector>

namespace {

using inlay::Command;
using inlay::ExitCode;

/// A new command is one line here, one declaration in command.h and one file.
const Command commands[] = {
    {"replay", "The main job: a recording with virtual objects in it", inlay::add_replay},
    {"render", "One view of a scene, without a recording", inlay::add_render},
    {"record", "A synthetic recording whose truth is known", inlay::add_record},
    {"info", "What a recording holds, what was assumed, what is wrong with it", inlay::add_info},
    {"reconstruct", "Where the camera was, and the room as a mesh", inlay::add_reconstruct},
    {"compare", "How far pictures are from their references: error figures", inlay::add_compare},
    {"accuracy", "Error against time, for every method and setting", inlay::add_accuracy},
};

// Beyond the codes that commands use, as sysexits has them.
constexpr int software_failure = 70;
constexpr int out_of_memory = 71;

void log_to_stderr() {
    auto logger = spdlog::stderr_color_mt("inlay");
    logger->set_pattern("inlay: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

int fail(int code, const std::string& message) {
    std::cerr << "inlay: " << message << std::endl;
    return code;
}

int code_of(const std::filesystem::filesystem_error& error) {
    const bool missing = error.code() == std::errc::no_such_file_or_directory;
    return int(missing ? ExitCode::input_missing : ExitCode::disk_fault);
}

int parse_and_run(int argc, char** argv) {
    CLI::App app{"Puts virtual objects into recorded RGB-D video, lit by the real room.", "inlay"};
    app.set_version_flag("--version", "inlay " INLAY_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Exit codes: 0 done; 2 usage; 65 bad data; 66 input missing; 70 internal failure;\n"
        "71 out of memory; 73 cannot create; 74 disk fault or full; 130 interrupted.");
    std::vector<std::pair<CLI::App*, std::function<int()>>> runs;
    for (const Command& command : commands) {
        CLI::App* subcommand = app.add_subcommand(command.name, command.description);
        runs.emplace_back(subcommand, command.add(*subcommand));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& error) {
        return fail(int(ExitCode::usage),
                    error.what() + std::string("\nRun inlay --help, or inlay COMMAND --help."));
    }
    for (const auto& [subcommand, run] : runs)
        if (subcommand->parsed()) return run();
    return int(ExitCode::usage);
}

int guarded_run(int argc, char** argv) {
    try {
        return parse_and_run(argc, argv);
    } catch (const inlay::Error& error) {
        return fail(int(error.code()), error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(code_of(error), error.what());
    } catch (const std::bad_alloc&) {
        return fail(out_of_memory, "out of memory; fewer frames or smaller images need less");
    } catch (const std::exception& error) {
        return fail(software_failure, std::string("internal failure: ") + error.what());
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::signal(SIGXFSZ,
                SIG_IGN);  // a file size limit is then an error of the write, as a full disk is
    inlay::keep_freed_memory();
    log_to_stderr();
    inlay::remember_invocation(argc, argv);
    const int code = guarded_run(argc, argv);
    std::cout.flush();
    if (code == 0 && !std::cout) return fail(int(ExitCode::disk_fault), "cannot write to stdout");
    return code;
}
