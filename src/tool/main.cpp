// The command `odds`.
#include <fmt/core.h>

#include <cstdio>
#include <exception>

#include "tool/command.hpp"

namespace odds::tool {

int fail(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message());
  return exit_error;
}

}  // namespace odds::tool

int main(int argc, char** argv) {
  CLI::App app{"odds: mesh collision inside a hard microsecond budget, with a probability where proof did not fit"};
  app.require_subcommand(1);
  odds::tool::Action action;
  odds::tool::add_inspect(app, action);
  odds::tool::add_query(app, action);
  odds::tool::add_run(app, action);
  odds::tool::add_explain(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& parse_error) {
    return app.exit(parse_error) == 0 ? odds::tool::exit_good : odds::tool::exit_usage;
  }
  try {
    return action ? action() : odds::tool::exit_usage;
  } catch (const std::exception& failure) {  // out of memory and the like: bad input never throws
    return odds::tool::fail({"", "", failure.what(), "this is a limit of the machine or a bug; please report it"});
  }
}
