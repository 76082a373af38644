// Files beside their targets, renamed when they are whole.
#include "mesh/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace odds::mesh {
namespace {

std::string reason(int number) { return std::generic_category().message(number); }

constexpr int most_links = 40;  // as Linux follows

// A link stays a link: what it points to is replaced, or made.
std::filesystem::path behind_links(std::filesystem::path path) {
  std::error_code unknown;
  for (int i = 0; i < most_links && std::filesystem::is_symlink(path, unknown); ++i) {
    path = path.parent_path() / std::filesystem::read_symlink(path, unknown);  // the latter alone if it is absolute
  }
  return path;
}

/// The open file of this program that a path such as /dev/stdout or /dev/fd/3 stands for. To go through its link would
/// replace a log that others write on, and what the program itself says there would get lost with the old one.
std::optional<int> own_descriptor(std::filesystem::path path) {
  std::error_code unknown;
  const std::filesystem::path ours = std::filesystem::canonical("/proc/self/fd", unknown);
  if (unknown) return std::nullopt;
  for (int i = 0; i < most_links && !path.empty(); ++i) {
    if (std::filesystem::canonical(path.has_parent_path() ? path.parent_path() : ".", unknown) == ours) {
      const std::string name = path.filename().string();
      int number = -1;
      const auto end = std::from_chars(name.data(), name.data() + name.size(), number);
      if (end.ec != std::errc{} || end.ptr != name.data() + name.size() || number < 0) return std::nullopt;
      return number;
    }
    if (!std::filesystem::is_symlink(path, unknown)) return std::nullopt;
    path = path.parent_path() / std::filesystem::read_symlink(path, unknown);
  }
  return std::nullopt;
}

/// Where the descriptor is, not at the beginning or the end of its file; null with errno.
std::FILE* stream_of(int descriptor) {
  const int own = fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  std::FILE* const stream = own < 0 ? nullptr : fdopen(own, "w");
  const int number = errno;
  if (stream == nullptr && own >= 0) ::close(own);
  errno = number;
  return stream;
}

}  // namespace

OutputFile::OutputFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* stream)
    : target_(std::move(target)),
      temporary_(std::move(temporary)),
      stream_(stream),
      unfinished_(temporary_.empty() ? UnfinishedFile() : UnfinishedFile(temporary_.string())) {}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      stream_(std::exchange(other.stream_, nullptr)),
      unfinished_(std::move(other.unfinished_)),
      failure_(other.failure_) {
  other.temporary_.clear();
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr && !target_.empty()) std::fclose(stream_);
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

Result<OutputFile> OutputFile::open_or_standard_output(const std::string& path) {
  if (path.empty()) {
    return Error{"", "", "the name of the output file is empty", "name a file, or - for standard output"};
  }
  if (path == "-" || own_descriptor(path) == STDOUT_FILENO) return OutputFile({}, {}, stdout);
  return open(path);
}

Result<OutputFile> OutputFile::open(const std::filesystem::path& path) {
  std::error_code unknown;
  if (path.empty()) return Error{"", "", "the name of the output file is empty", "name a file"};
  if (std::filesystem::is_directory(path, unknown)) {
    return Error{path.string(), "", "cannot be written: it is a directory", "name a file"};
  }
  // Devices and pipes cannot be replaced by renaming.
  const std::optional<int> descriptor = own_descriptor(path);
  if (descriptor || (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))) {
    std::FILE* stream = descriptor ? stream_of(*descriptor) : std::fopen(path.c_str(), "w");
    if (stream == nullptr) {
      return Error{path.string(), "", "cannot be written: " + reason(errno), "check the permissions"};
    }
    return OutputFile(path, {}, stream);
  }
  const std::filesystem::path target = behind_links(path);
  if (std::filesystem::is_symlink(target, unknown)) {
    return Error{path.string(), "", "cannot be written: its links lead in a circle", "name a file"};
  }
  return open_beside(path, target);
}

Result<OutputFile> OutputFile::open_beside(const std::filesystem::path& path, const std::filesystem::path& target) {
  struct stat replaced {};
  const bool replaces = ::stat(target.c_str(), &replaced) == 0;
  if (!replaces && errno == ENAMETOOLONG) {
    return Error{path.string(), "", "cannot be written: " + reason(errno), "give it a shorter name"};
  }
  static std::atomic<unsigned> number{0};  // two threads may write to one path
  constexpr int most_trials = 100;         // a process of this number may have died here before
  for (int trial = 0; trial < most_trials; ++trial) {
    // Not the target's name and more: that may be as long as names can be.
    const std::filesystem::path temporary = target.parent_path() / ("odds-" + std::to_string(getpid()) + "-" +
                                                                    std::to_string(number.fetch_add(1)) + ".part");
    // At no moment more open than what it replaces.
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, replaces ? 0600U : 0666U);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor >= 0 && replaces) static_cast<void>(fchmod(descriptor, replaced.st_mode & 07777U));
    std::FILE* stream = descriptor < 0 ? nullptr : fdopen(descriptor, "w");
    if (stream == nullptr) break;
    return OutputFile(target, temporary, stream);
  }
  return Error{path.string(), "", "cannot be written: " + reason(errno),
               "check that the folder exists and may be written to"};
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
  // Else a power failure could leave the new name with none of the new bytes.
  if (failure_ == 0 && !temporary_.empty() && fsync(fileno(stream_)) != 0) failure_ = errno;
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

std::streamsize OutputStream::Buffer::xsputn(const char* text, std::streamsize count) {
  file_.write(std::string_view(text, static_cast<std::size_t>(count)));
  return file_.good() ? count : 0;
}

OutputStream::Buffer::int_type OutputStream::Buffer::overflow(int_type character) {
  if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
  const char text = traits_type::to_char_type(character);
  return xsputn(&text, 1) == 1 ? character : traits_type::eof();
}

std::optional<Error> write_file(const std::filesystem::path& path, std::string_view text) {
  Result<OutputFile> file = OutputFile::open(path);
  if (!file.ok()) return file.error();
  file.value().write(text);
  return file.value().commit();
}

}  // namespace odds::mesh
