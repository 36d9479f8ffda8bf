// Memory on large pages holds what any other does, whatever its size.
#include "base/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <utility>

#include "base/sanitized.h"

namespace rubble {
namespace {

TEST(LargePages, ABufferHoldsWhatWasWrittenWhateverItsSize) {
  for (const std::size_t bytes :
       {std::size_t{10}, std::size_t{500'000}, std::size_t{600'000}, std::size_t{6'000'000}}) {
    LargeBuffer buffer(bytes);
    LargeBuffer other(bytes);
    for (std::size_t i = 0; i < bytes; ++i) {
      buffer.data()[i] = static_cast<std::uint8_t>(i * 7U);
      other.data()[i] = 3;
    }
    for (std::size_t i = 0; i < bytes; ++i) ASSERT_EQ(buffer.data()[i], static_cast<std::uint8_t>(i * 7U)) << i;
    EXPECT_EQ(std::count(other.data(), other.data() + bytes, 3), static_cast<std::ptrdiff_t>(bytes));
  }
}

TEST(LargePages, LargeMemoryBeginsAtALargePage) {
  if (kAddressSanitizer) GTEST_SKIP() << "sanitizers hand out memory of their own";
  constexpr std::size_t kPage = std::size_t{1} << 21U;
  for (const std::size_t bytes : {kPage, kPage + 1, 5 * kPage - 1}) {
    void* const memory = allocate_large(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % kPage, 0U) << bytes;
    free_large(memory, bytes);
  }
}

TEST(LargePages, ABufferStaysWhereItIsUnlessItMustGrow) {
  LargeBuffer buffer;
  std::uint8_t* const first = buffer.hold(4'000'000);
  std::fill_n(first, 4'000'000, std::uint8_t{7});
  EXPECT_EQ(buffer.hold(100), first);
  EXPECT_EQ(buffer.hold(4'000'000), first);
  EXPECT_EQ(std::count(first, first + 4'000'000, 7), 4'000'000);
  LargeBuffer other = std::move(buffer);
  EXPECT_EQ(other.hold(1), first);
  buffer = LargeBuffer();
  std::fill_n(buffer.hold(30'000'000), 30'000'000, std::uint8_t{1});
  std::fill_n(other.hold(20'000'000), 20'000'000, std::uint8_t{2});
  buffer = std::move(other);
  EXPECT_EQ(std::count(buffer.hold(1), buffer.hold(1) + 20'000'000, 2), 20'000'000);
}

TEST(LargePages, WhatNoMachineHasIsRefused) {
  if (kAddressSanitizer) GTEST_SKIP() << "there such a request ends the program";
  EXPECT_THROW(allocate_large(std::numeric_limits<std::size_t>::max()), std::bad_alloc);
  EXPECT_THROW(allocate_large(std::numeric_limits<std::size_t>::max() / 2), std::bad_alloc);
}

}  // namespace
}  // namespace rubble
