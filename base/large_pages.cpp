#include "base/large_pages.h"

#include <sys/mman.h>

#include <cstdint>
#include <new>
#include <utility>

#include "base/sanitized.h"

namespace rubble {

namespace {

constexpr std::size_t kPage = std::size_t{1} << 21U;
/// From here on a page is worth what is left over of it; under a sanitizer, which watches over operator new, never.
constexpr std::size_t kLarge = kAddressSanitizer ? SIZE_MAX : kPage / 4;

std::size_t whole_pages(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

}  // namespace

// Mapped anew each time: what malloc() hands out a second time keeps the small pages of before.
void* allocate_large(std::size_t bytes) {
  if (bytes < kLarge) return ::operator new(bytes);
  if (bytes > PTRDIFF_MAX - 2 * kPage) throw std::bad_alloc();
  const std::size_t whole = whole_pages(bytes);
  void* const mapped = mmap(nullptr, whole + kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  auto* const begin = static_cast<char*>(mapped);
  const std::size_t before = (kPage - reinterpret_cast<std::uintptr_t>(begin) % kPage) % kPage;
  if (before > 0) munmap(begin, before);
  munmap(begin + before + whole, kPage - before);
  madvise(begin + before, whole, MADV_HUGEPAGE);  // a wish: a system without such pages goes on with small ones
  return begin + before;
}

void free_large(void* memory, std::size_t bytes) noexcept {
  if (bytes < kLarge)
    ::operator delete(memory);
  else
    munmap(memory, whole_pages(bytes));
}

LargeBuffer::LargeBuffer(LargeBuffer&& other) noexcept
    : memory_(std::exchange(other.memory_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}

LargeBuffer& LargeBuffer::operator=(LargeBuffer&& other) noexcept {
  std::swap(memory_, other.memory_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

std::uint8_t* LargeBuffer::hold(std::size_t bytes) {
  if (bytes > bytes_) {
    free_large(std::exchange(memory_, nullptr), std::exchange(bytes_, 0));
    const std::size_t roomy = bytes + bytes / 2;  // what grows bit by bit is not taken anew each time
    memory_ = allocate_large(roomy);
    bytes_ = roomy;
  }
  return static_cast<std::uint8_t*>(memory_);
}

}  // namespace rubble
