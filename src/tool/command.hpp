// How a sub-command joins the tool: one file each, one line in main.cpp.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

#include "odds/math/error.hpp"

namespace odds::tool {

inline constexpr int exit_good = 0;
inline constexpr int exit_error = 1;  ///< bad input; one line "error: FILE:LINE: what; what to do" on stderr
inline constexpr int exit_usage = 2;  ///< wrong usage of the command line

/// What a parsed sub-command does; returns the exit status.
using Action = std::function<int()>;

/// Prints "error: ..." to stderr and returns exit_error.
int fail(const Error& error);

// Each adds its sub-command to `app` and sets `action` when it was chosen.
void add_inspect(CLI::App& app, Action& action);
void add_build(CLI::App& app, Action& action);
void add_query(CLI::App& app, Action& action);
void add_distance(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_accuracy(CLI::App& app, Action& action);
void add_import(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);

}  // namespace odds::tool
