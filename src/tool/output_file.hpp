// An output file that is there complete or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "odds/math/error.hpp"

namespace odds::tool {

/// Writes to a temporary file beside the target and renames it in `commit`; until then, and after any failure, what
/// stood at the target stays. "-" is standard output, written at once.
class OutputFile {
 public:
  static Result<OutputFile> open(const std::string& path);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);
  [[nodiscard]] bool is_standard_output() const { return target_.empty(); }
  /// Flushes and puts the file in place; the error names the file and what the system said.
  std::optional<Error> commit();

 private:
  OutputFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* stream);
  std::filesystem::path target_;  ///< empty for standard output
  std::filesystem::path temporary_;
  std::FILE* stream_;
  int failure_ = 0;  ///< the first errno of a write
};

/// An error if `output` is, by whatever name, one of the files to read.
std::optional<Error> refuse_overwriting(const std::string& output, std::initializer_list<std::string> inputs);

}  // namespace odds::tool
