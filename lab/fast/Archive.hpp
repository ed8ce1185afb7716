#pragma once
/** @file Archive.hpp
 * Archive: saves objects as bytes and loads them again. */
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lab {

/** What has a function archive(Archive&), as below. */
template <typename T>
concept Archived = requires {
  &T::archive;
};

/** A type whose values are saved byte by byte. */
template <typename T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> &&
                !Archived<T> && !requires {
  typename T::element_type;
};  // a span

/** A list of values as bytes: one that saves takes them, one that loads gives
 * them back in the same order. So one function of a class does both:
 *
 *     void archive(Archive& a) { a(time_)(positions_); }
 *
 * Bytes are as in memory: of numbers and structs of numbers, without pointers,
 * for the same program on the same kind of machine. What is loaded may be
 * forged: call require() to check its range. */
class Archive {
 public:
  /** Saves. */
  Archive() = default;
  /** Loads what another one saved as @a bytes. */
  explicit Archive(std::string bytes)
      : bytes_(std::move(bytes)), loads_(true) {}

  bool loads() const { return loads_; }
  const std::string& bytes() const { return bytes_; }
  /** True if all has been loaded. */
  bool at_end() const { return at_ == bytes_.size(); }

  /** Save @a x, or load it. Of a list its length, too; of a span the length
   * must be the same.
   * Throws std::runtime_error: too few bytes are left, or another length. */
  template <typename T>
  requires Plain<T> Archive& operator()(T& x) { return copy(&x, 1); }
  template <typename T>
  requires Archived<T> Archive& operator()(T& x) {
    return x.archive(*this), *this;
  }
  /** Only 0 and 1 are loaded as a bool. */
  Archive& operator()(bool& x) {
    char byte = x;
    copy(&byte, 1).require(byte == 0 || byte == 1);
    x = byte == 1;
    return *this;
  }
  template <typename T>
  Archive& operator()(std::vector<T>& list) {
    const std::uint64_t length = length_of(list.size(), sizeof(T));
    if (loads_) list.resize(length);
    return copy(list.data(), length);
  }
  Archive& operator()(std::string& text) {
    const std::uint64_t length = length_of(text.size(), 1);
    if (loads_) text.resize(length);
    return copy(text.data(), length);
  }
  template <typename T>
  Archive& operator()(std::span<T> list) {
    if (length_of(list.size(), sizeof(T)) != list.size())
      throw std::runtime_error("has a list of the wrong length");
    return copy(list.data(), list.size());
  }

  /** Throws std::runtime_error if what was loaded is not @a ok. */
  void require(bool ok) const {
    if (loads_ && !ok) throw std::runtime_error("has an invalid value");
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;  // of what comes next to load
  bool loads_ = false;

  std::uint64_t length_of(std::uint64_t length, std::size_t size) {
    (*this)(length);
    if (loads_ && length > (bytes_.size() - at_) / size)
      throw std::runtime_error("ends too early");
    return length;
  }
  template <typename T>
  Archive& copy(T* x, std::uint64_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t size = count * sizeof(T);
    if (size == 0) return *this;  // and x may be null
    if (!loads_) {
      bytes_.append(reinterpret_cast<const char*>(x), size);
      return *this;
    }
    if (size > bytes_.size() - at_) throw std::runtime_error("ends too early");
    std::memcpy(static_cast<void*>(x), bytes_.data() + at_, size);
    at_ += size;
    return *this;
  }
};

}  // namespace lab
