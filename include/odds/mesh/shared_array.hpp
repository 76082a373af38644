// Elements that nobody changes any more, and what keeps them: a vector of their own, or a part of a mapped file.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace odds::mesh {

/// Copies share the elements; each copy keeps them alive. Reading is as fast as from a vector. Thread-safe to share.
template <class T>
class SharedArray {
 public:
  SharedArray() = default;

  /// Takes the vector; one allocation.
  SharedArray(std::vector<T>&& owned) {  // NOLINT: implicit on purpose
    auto keeper = std::make_shared<const std::vector<T>>(std::move(owned));
    elements_ = *keeper;
    keeper_ = std::move(keeper);
  }

  /// Looks at elements that `keeper` keeps where they are.
  SharedArray(std::span<const T> elements, std::shared_ptr<const void> keeper) noexcept
      : elements_(elements), keeper_(std::move(keeper)) {}

  [[nodiscard]] std::span<const T> span() const noexcept { return elements_; }
  [[nodiscard]] const T* data() const noexcept { return elements_.data(); }
  [[nodiscard]] std::size_t size() const noexcept { return elements_.size(); }
  [[nodiscard]] bool empty() const noexcept { return elements_.empty(); }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return elements_[i]; }
  [[nodiscard]] std::size_t bytes() const noexcept { return elements_.size_bytes(); }

 private:
  std::span<const T> elements_;
  std::shared_ptr<const void> keeper_;
};

}  // namespace odds::mesh
