#include "robot/logs/own/range_codec.h"

#include "tests/support/robot_inputs.h"

namespace rubble::robot {
namespace {

using testing::kMiss;
using testing::kUnknown;

std::vector<float> round_trip(const std::vector<float>& ranges) {
  std::string bytes;
  encode_ranges(ranges, bytes);
  ByteReader reader(bytes);
  std::vector<float> back = decode_ranges(reader, ranges.size());
  EXPECT_EQ(reader.left(), 0u);
  return back;
}

float metres(int mm) { return static_cast<float>(mm * 0.001); }

TEST(RangeCodec, EveryWholeMillimetreToSixtyMetresKeepsItsBits) {
  std::vector<float> ranges;
  for (int mm = 0; mm <= 60000; ++mm) ranges.push_back(metres(mm));
  EXPECT_TRUE(testing::same(round_trip(ranges), ranges));
  std::string bytes;
  encode_ranges(ranges, bytes);
  EXPECT_EQ(bytes.size(), ranges.size()) << "steps of 1 mm take one byte each";
}

TEST(RangeCodec, EveryKindOfFloatKeepsItsBits) {
  const auto from_bits = [](std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  };
  const std::vector<float> ranges{0.0f,
                                  -0.0f,
                                  kMiss,
                                  -kMiss,
                                  kUnknown,
                                  -1.234f,
                                  1.2345678f,
                                  7999.999f,
                                  8000.0f,
                                  8000.001f,
                                  1e30f,
                                  1e-40f,
                                  from_bits(0x7fc00001u),
                                  from_bits(0x7f800001u),
                                  from_bits(0xffc00000u),
                                  5.6f,
                                  0.02f};
  EXPECT_TRUE(testing::same(round_trip(ranges), ranges));
  EXPECT_TRUE(round_trip({}).empty());
}

TEST(RangeCodec, JumpsOfAnySizeKeepTheirBits) {
  std::vector<float> ranges;
  for (const int mm : {0, 95, 0, 96, 0, 97, 0, 6239, 0, 6240, 0, 6241, 0, 30000, 0, 8000000, 0})
    ranges.push_back(metres(mm));
  EXPECT_TRUE(testing::same(round_trip(ranges), ranges));
}

TEST(RangeCodec, RunsOfMissesOfAnyLengthKeepTheirLength) {
  for (const std::size_t length : {1u, 2u, 255u, 256u, 257u, 512u, 513u}) {
    std::vector<float> ranges(length, kMiss);
    ranges.insert(ranges.end(), length, kUnknown);
    ranges.push_back(1.0f);
    EXPECT_TRUE(testing::same(round_trip(ranges), ranges)) << length;
  }
}

TEST(RangeCodec, ScanOfARoomTakesAtMostOneAndAHalfBytesABeam) {
  LaserModel laser;
  Rng noise(1, "noise");
  LaserScan scan = testing::room_scan(Stamp{0}, 0.4, -0.3, 0.2, 2.5, laser);
  for (float& range : scan.ranges)
    if (range < kMiss)
      range = static_cast<float>(std::round((static_cast<double>(range) + noise.gaussian(0.01)) * 1000.0) * 0.001);
  std::string bytes;
  encode_ranges(scan.ranges, bytes);
  EXPECT_LT(static_cast<double>(bytes.size()), 1.5 * static_cast<double>(scan.ranges.size()));
  EXPECT_TRUE(testing::same(round_trip(scan.ranges), scan.ranges));
}

TEST(RangeCodec, GarbageIsRefusedOrDecodedButNeverReadBeyondItsEnd) {
  const std::uint64_t seed = 20;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Rng rng(seed, "garbage");
  for (int trial = 0; trial < 20000; ++trial) {
    std::string bytes(rng.below(40), '\0');
    for (char& byte : bytes) byte = static_cast<char>(rng.below(256));
    const std::size_t beams = rng.below(100);
    ByteReader reader(bytes);
    try {
      EXPECT_EQ(decode_ranges(reader, beams).size(), beams);
    } catch (const BadPayload&) {
    }
  }
  ByteReader none("");
  EXPECT_THROW(decode_ranges(none, std::size_t{1} << 60), BadPayload);
}

}  // namespace
}  // namespace rubble::robot
