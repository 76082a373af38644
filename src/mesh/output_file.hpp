// An output file that is there complete or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <ostream>
#include <streambuf>
#include <string>
#include <string_view>

#include "mesh/unfinished_file.hpp"
#include "odds/math/error.hpp"

namespace odds::mesh {

/// Writes to a temporary file beside the target, of a name of its own, and renames it in `commit`, when the disk has
/// it; until then, and after any failure, what stood at the target stays. A link stays a link, what it points to is
/// replaced; devices and pipes are written at once, and files that this program has open, as /dev/stdout, are written
/// on. Any number of threads may write to one path: the last to commit wins whole.
class OutputFile {
 public:
  static Result<OutputFile> open(const std::filesystem::path& path);
  /// "-" is standard output, written at once, and so is /dev/stdout.
  static Result<OutputFile> open_or_standard_output(const std::string& path);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);
  [[nodiscard]] bool is_standard_output() const { return target_.empty(); }
  /// Whether every write until now succeeded, as far as the system has said.
  [[nodiscard]] bool good() const { return failure_ == 0; }
  /// Flushes and puts the file in place; the error names the file and what the system said.
  std::optional<Error> commit();

 private:
  OutputFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* stream);
  static Result<OutputFile> open_beside(const std::filesystem::path& path, const std::filesystem::path& target);
  std::filesystem::path target_;  ///< empty for standard output
  std::filesystem::path temporary_;
  std::FILE* stream_;
  UnfinishedFile unfinished_;
  int failure_ = 0;  ///< the first errno of a write
};

/// A stream into an OutputFile, which must outlive it; it fails when the file does.
class OutputStream : public std::ostream {
 public:
  explicit OutputStream(OutputFile& file) : std::ostream(nullptr), buffer_(file) { rdbuf(&buffer_); }

 private:
  class Buffer : public std::streambuf {
   public:
    explicit Buffer(OutputFile& file) : file_(file) {}

   protected:
    std::streamsize xsputn(const char* text, std::streamsize count) override;
    int_type overflow(int_type character) override;

   private:
    OutputFile& file_;
  };
  Buffer buffer_;
};

/// A whole file at once.
[[nodiscard]] std::optional<Error> write_file(const std::filesystem::path& path, std::string_view text);

/// An error if `output` is, by whatever name, one of the files to read.
std::optional<Error> refuse_overwriting(const std::string& output, std::initializer_list<std::string> inputs);

}  // namespace odds::mesh
