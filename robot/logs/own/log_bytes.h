#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/input_file.h"

namespace rubble::robot {

/// The bytes of a log, looked at piece by piece: a log of ten hours is a gigabyte.
class LogBytes {
 public:
  virtual ~LogBytes() = default;
  virtual std::size_t size() const = 0;
  /// `count` bytes from `offset` on, all of them within size(); valid until the next call. Throws InputError.
  virtual std::string_view at(std::size_t offset, std::size_t count) = 0;
};

/// Of others, who keep them.
class SeenBytes : public LogBytes {
 public:
  explicit SeenBytes(std::string_view bytes) : bytes_(bytes) {}
  std::size_t size() const override { return bytes_.size(); }
  std::string_view at(std::size_t offset, std::size_t count) override { return bytes_.substr(offset, count); }

 private:
  std::string_view bytes_;
};

/// What came through a pipe or was unpacked.
class HeldBytes : public LogBytes {
 public:
  explicit HeldBytes(std::string bytes) : bytes_(std::move(bytes)) {}
  std::size_t size() const override { return bytes_.size(); }
  std::string_view at(std::size_t offset, std::size_t count) override {
    return std::string_view(bytes_).substr(offset, count);
  }

 private:
  std::string bytes_;
};

/// A file, of which a megabyte is held. What is written to it later is not seen.
class FileBytes : public LogBytes {
 public:
  /// `file` has a size.
  explicit FileBytes(std::unique_ptr<InputFile> file) : file_(std::move(file)), size_(file_->size().value()) {}
  std::size_t size() const override { return size_; }
  std::string_view at(std::size_t offset, std::size_t count) override;

 private:
  std::unique_ptr<InputFile> file_;
  std::size_t size_;
  std::vector<char> window_;  ///< the bytes from begin_ on
  std::size_t begin_ = 0;
};

}  // namespace rubble::robot
