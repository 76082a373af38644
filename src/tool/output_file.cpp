#include "tool/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace odds::tool {
namespace {

std::string reason(int number) { return std::generic_category().message(number); }

}  // namespace

OutputFile::OutputFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* stream)
    : target_(std::move(target)), temporary_(std::move(temporary)), stream_(stream) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      stream_(std::exchange(other.stream_, nullptr)),
      failure_(other.failure_) {
  other.temporary_.clear();
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr && !target_.empty()) std::fclose(stream_);
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

Result<OutputFile> OutputFile::open(const std::string& path) {
  if (path.empty())
    return Error{"", "", "the name of the output file is empty", "name a file, or - for standard output"};
  if (path == "-") return OutputFile({}, {}, stdout);
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) {
    return Error{path, "", "cannot be written: it is a directory", "name a file"};
  }
  // Devices and pipes cannot be replaced by renaming.
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown)) {
    std::FILE* stream = std::fopen(path.c_str(), "w");
    if (stream == nullptr) return Error{path, "", "cannot be written: " + reason(errno), "check the permissions"};
    return OutputFile(path, {}, stream);
  }
  // A link stays a link: what it points to is replaced.
  const bool link = std::filesystem::is_symlink(path, unknown);
  const std::filesystem::path given(path);
  const std::filesystem::path resolved = link ? std::filesystem::weakly_canonical(given, unknown) : given;
  const std::filesystem::path& target = resolved.empty() ? given : resolved;
  const std::string temporary = target.string() + ".part" + std::to_string(getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  std::FILE* stream = descriptor < 0 ? nullptr : fdopen(descriptor, "w");
  if (stream == nullptr) {
    return Error{path, "", "cannot be written: " + reason(errno), "check that the folder exists and may be written to"};
  }
  return OutputFile(target, temporary, stream);
}

std::optional<Error> refuse_overwriting(const std::string& output, std::initializer_list<std::string> inputs) {
  for (const std::string& input : inputs) {
    std::error_code unknown;
    if (!std::filesystem::equivalent(output, input, unknown) || unknown) continue;
    return Error{output, "", "is also an input, which would be overwritten", "name another file for the output"};
  }
  return std::nullopt;
}

void OutputFile::write(std::string_view text) {
  if (failure_ == 0 && std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) failure_ = errno;
}

std::optional<Error> OutputFile::commit() {
  if (std::fflush(stream_) != 0 && failure_ == 0) failure_ = errno;
  if (target_.empty()) {
    if (failure_ != 0)
      return Error{"standard output", "", "cannot be written: " + reason(failure_), "check where it goes"};
    return std::nullopt;
  }
  if (std::fclose(std::exchange(stream_, nullptr)) != 0 && failure_ == 0) failure_ = errno;
  if (failure_ == 0 && !temporary_.empty()) {
    if (std::rename(temporary_.c_str(), target_.c_str()) == 0) {
      temporary_.clear();
    } else {
      failure_ = errno;
    }
  }
  if (failure_ == 0) return std::nullopt;
  return Error{target_.string(), "", "cannot be written: " + reason(failure_),
               "check the space left and the permissions"};
}

}  // namespace odds::tool
