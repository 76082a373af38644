// Which files are being written, for whoever has to end the program in the middle. Private to what writes files.
#pragma once

#include <cstddef>
#include <string>

namespace odds::mesh {

/// Takes note of a temporary file for as long as it lives. The names of `most` at a time are known, and of no longer
/// ones than the system opens; of further ones nothing is.
class UnfinishedFile {
 public:
  static constexpr std::size_t most = 16;

  UnfinishedFile() = default;
  explicit UnfinishedFile(const std::string& path) noexcept;
  ~UnfinishedFile();
  UnfinishedFile(UnfinishedFile&& other) noexcept;
  UnfinishedFile& operator=(UnfinishedFile&&) = delete;

 private:
  std::size_t slot_ = most;  ///< most: none
};

/// Removes the files of which note is taken. For handlers of signals that end the program: async-signal-safe.
void remove_unfinished_files() noexcept;

}  // namespace odds::mesh
