// Command: one row of the program's table of commands, and the functions that add each of them.
#pragma once

#include <CLI/App.hpp>

#include <functional>

namespace inlay {

struct Command {
    const char* name;
    const char* description;
    /// Adds the command's options to its subcommand and returns what runs after parsing: a
    /// function whose result is the exit code. Options live as long as that function.
    std::function<int()> (*add)(CLI::App& subcommand);
};

std::function<int()> add_accuracy(CLI::App& subcommand);
std::function<int()> add_compare(CLI::App& subcommand);
std::function<int()> add_info(CLI::App& subcommand);
std::function<int()> add_reconstruct(CLI::App& subcommand);
std::function<int()> add_record(CLI::App& subcommand);
std::function<int()> add_render(CLI::App& subcommand);
std::function<int()> add_replay(CLI::App& subcommand);

}  // namespace inlay
