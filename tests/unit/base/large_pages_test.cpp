// Memory on large pages holds what any other does, whatever its size.
#include "base/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <numeric>
#include <utility>

#include "base/sanitized.h"

namespace rubble {
namespace {

TEST(LargePages, AVectorGrowsOverTheSizeFromWhichPagesAreLargeAndKeepsWhatItHolds) {
  LargeVector<std::uint16_t> numbers;
  constexpr std::uint32_t kCount = 3'000'000;  // 6 MB
  for (std::uint32_t i = 0; i < kCount; ++i) numbers.push_back(static_cast<std::uint16_t>(i * 7U));
  for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(numbers[i], static_cast<std::uint16_t>(i * 7U)) << i;
  const LargeVector<std::uint16_t> copy = numbers;
  numbers.assign(10, 3);
  numbers.shrink_to_fit();
  EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0), 30);
  EXPECT_EQ(copy.size(), kCount);
  EXPECT_EQ(copy.back(), static_cast<std::uint16_t>((kCount - 1) * 7U));
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
