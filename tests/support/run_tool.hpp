// Running the command `odds` itself and keeping what it said.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "support/temporary_folder.hpp"

namespace odds::testing {

struct Ran {
  int status = -1;     ///< exit status, or -1 if a signal ended it
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
};

/// `arguments` as a shell would read them; run in `folder`.
inline Ran run_tool(const TemporaryFolder& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.path().string() + "' && '" + ODDS_TOOL + "' " + arguments +
                              " >stdout.txt 2>stderr.txt </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents_of(folder / "stdout.txt"),
          contents_of(folder / "stderr.txt")};
}

}  // namespace odds::testing
