// Refilling the window, and the words for running out of bytes.
#include "mesh/input.hpp"

#include "mesh/refusal.hpp"

namespace odds::mesh {
namespace {

constexpr std::uint64_t window_bytes = std::uint64_t{1} << 18;

}  // namespace

Input::Input(ByteSource& source, std::string name)
    : source_(source),
      name_(std::move(name)),
      window_(static_cast<std::size_t>(std::clamp<std::uint64_t>(source.size_hint(), 1, window_bytes)) + 1),
      cursor_(window_.data()),
      limit_(window_.data()) {
  window_[0] = '\n';
}

bool Input::refill(std::size_t count) {
  if (!at_end_) {
    const std::size_t kept = available();
    base_ += static_cast<std::uint64_t>(cursor_ - window_.data());
    std::memmove(window_.data(), cursor_, kept);
    const std::size_t room = window_.size() - 1 - kept;
    const std::size_t got = source_.read(std::as_writable_bytes(std::span(window_.data() + kept, room)));
    at_end_ = got < room || room == 0;
    cursor_ = window_.data();
    limit_ = cursor_ + kept + got;
    window_[kept + got] = '\n';
  }
  return available() >= count;
}

void Input::skip(std::uint64_t size) {
  while (size > 0) {
    if (!fill(1)) refuse_end(static_cast<std::size_t>(size));
    const std::uint64_t step = std::min<std::uint64_t>(size, available());
    cursor_ += step;
    size -= step;
  }
}

std::uint64_t Input::remaining() {
  const std::uint64_t total = source_.size();
  return total > offset() ? total - offset() : 0;  // a file may shrink while it is read
}

std::string Input::place() const {
  if (!binary) return std::to_string(line);
  return "byte " + std::to_string(record_offset_) + (source_.packed() ? " (unpacked)" : "");
}

void Input::refuse(std::string what, std::string remedy) const {
  throw Refusal{{name_, place(), std::move(what), std::move(remedy)}};
}

void Input::refuse_at(std::string place, std::string what, std::string remedy) const {
  throw Refusal{{name_, std::move(place), std::move(what), std::move(remedy)}};
}

void Input::refuse_end(std::size_t size) {
  record_offset_ = offset();
  refuse("the file ends here, but " + std::to_string(size) + " more bytes belong to this record (" +
             std::to_string(available()) + " are left)",
         "the file is truncated: copy or export it again");
}

}  // namespace odds::mesh
