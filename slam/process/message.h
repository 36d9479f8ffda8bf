#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rubble::slam {

/// What the other side said is not of the protocol: what() tells what, without the place.
class BadMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The first words either side says. A program of another version is refused.
constexpr int kProtocolVersion = 1;
/// No line but a map's rows is longer [bytes].
constexpr std::size_t kLongestLine = 1u << 20;
constexpr int kMostMapCells = 8000;               ///< of a map, a side
constexpr std::size_t kMostPoses = 10'000'000;    ///< of a trajectory
constexpr std::size_t kMostBeams = 1'000'000;     ///< of a scan
constexpr std::size_t kMostRecords = 1'000'000;   ///< lines of one message
constexpr std::size_t kMostParameters = 100'000;  ///< lines of the parameters

/// Where bytes come from.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Waits for at least one byte; 0: there are no more.
  virtual std::size_t read(char* to, std::size_t at_most) = 0;
};

/// The bytes of a file descriptor.
class DescriptorSource : public ByteSource {
 public:
  explicit DescriptorSource(int descriptor) : descriptor_(descriptor) {}
  std::size_t read(char* to, std::size_t at_most) override;

 private:
  int descriptor_;
};

/// Lines of text and blocks of bytes, in the order in which they come.
class MessageReader {
 public:
  explicit MessageReader(ByteSource& source) : source_(source) {}

  /// The next line without its end (\n or \r\n); valid until the next call. False: there are no more lines. Throws
  /// BadMessage for a line longer than `limit` and for one that ends without a line end.
  bool line(std::string_view& text, std::size_t limit = kLongestLine);
  /// Fills `to` with `size` bytes. Throws BadMessage when there are fewer.
  void block(char* to, std::size_t size);

 private:
  bool fill();

  ByteSource& source_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

/// Stamps and counts of 64 bits: whatever their sign bit leaves.
inline constexpr std::int64_t kAnyStamp = std::numeric_limits<std::int64_t>::max();

/// The words of one line, one after the other. Throws BadMessage on a missing, a wrong, or (by finish) a spare one.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line), line_(line) {}

  std::string_view word();
  /// Any number, also inf and nan.
  double real();
  /// A finite number, |value| <= limit.
  double number(double limit = 1e9);
  std::int64_t whole(std::int64_t low, std::int64_t high);
  /// All that is left, without the space before it.
  std::string_view rest();
  void finish();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::string_view rest_;
  std::string_view line_;
};

/// Appends a space and the shortest text that reads back as the same number.
void append_number(std::string& text, double value);
void append_number(std::string& text, float value);
void append_number(std::string& text, std::int64_t value);

}  // namespace rubble::slam
