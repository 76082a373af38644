// The command `odds`.
#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <string>

#include "tool/command.hpp"
#include "tool/ending.hpp"
#include "tool/one_line.hpp"
#include "tool/standard_streams.hpp"
#include "tool/usage_error.hpp"

namespace odds::tool {

int fail(const Error& error) {
  fmt::print(stderr, "error: {}\n", on_one_line(error.message()));
  return exit_error;
}

namespace {

/// What the action said counts only once it has left this program.
int with_output_written(int status) {
  const auto error = flush_standard_output();
  return status == exit_good && error ? fail(*error) : status;
}

}  // namespace
}  // namespace odds::tool

int main(int argc, char** argv) {
  odds::tool::occupy_closed_streams();
  odds::tool::survive_size_limits();
  odds::tool::leave_no_unfinished_files();
  CLI::App app{"odds: mesh collision inside a hard microsecond budget, with a probability where proof did not fit"};
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("odds ") + ODDS_VERSION, "Print the version and exit");
  odds::tool::Action action;
  odds::tool::add_inspect(app, action);
  odds::tool::add_build(app, action);
  odds::tool::add_query(app, action);
  odds::tool::add_distance(app, action);
  odds::tool::add_accuracy(app, action);
  odds::tool::add_run(app, action);
  odds::tool::add_explain(app, action);
  odds::tool::add_import(app, action);
  odds::tool::add_compare(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& parse_error) {
    const std::string unknown = parse_error.get_exit_code() == 0 ? "" : odds::tool::unknown_word(app);
    if (!unknown.empty()) {
      fmt::print(stderr, "{}\nRun with --help for more information.\n", unknown);
      return odds::tool::exit_usage;
    }
    if (app.exit(parse_error) != 0) return odds::tool::exit_usage;
    return odds::tool::with_output_written(odds::tool::exit_good);
  }
  try {
    return action ? odds::tool::with_output_written(action()) : odds::tool::exit_usage;
  } catch (const std::exception& failure) {  // out of memory and the like: bad input never throws
    if (const auto error = odds::tool::flush_standard_output()) return odds::tool::fail(*error);
    return odds::tool::fail({"", "", failure.what(), "this is a limit of the machine or a bug; please report it"});
  }
}
