#pragma once

#include <cstddef>
#include <cstdint>

namespace rubble {

/// Memory for planes of megabytes. The system is asked to lay it on pages of 2 MB: what is touched first then costs one
/// fault for each of them instead of 512, which on some virtual machines take 14 us each. From 512 kB on it takes whole
/// pages of that size. Throws std::bad_alloc.
void* allocate_large(std::size_t bytes);
void free_large(void* memory, std::size_t bytes) noexcept;

/// Such memory for work that is done again and again on more and less of it. It stays when less is asked for: what is
/// given back and taken anew must be touched first each time.
class LargeBuffer {
 public:
  LargeBuffer() = default;
  /// Of so many bytes, of any values. Throws std::bad_alloc.
  explicit LargeBuffer(std::size_t bytes) : memory_(allocate_large(bytes)), bytes_(bytes) {}
  LargeBuffer(LargeBuffer&& other) noexcept;
  LargeBuffer& operator=(LargeBuffer&& other) noexcept;
  LargeBuffer(const LargeBuffer&) = delete;
  LargeBuffer& operator=(const LargeBuffer&) = delete;
  ~LargeBuffer() { free_large(memory_, bytes_); }

  /// So many bytes at least, of any values. Throws std::bad_alloc, and then holds nothing.
  std::uint8_t* hold(std::size_t bytes);
  std::uint8_t* data() { return static_cast<std::uint8_t*>(memory_); }

 private:
  void* memory_ = nullptr;
  std::size_t bytes_ = 0;
};

}  // namespace rubble
