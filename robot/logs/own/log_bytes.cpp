#include "robot/logs/own/log_bytes.h"

#include <algorithm>

#include "base/error.h"

namespace rubble::robot {

std::string_view FileBytes::at(std::size_t offset, std::size_t count) {
  constexpr std::size_t kWindow = std::size_t{1} << 20;
  if (offset < begin_ || offset + count > begin_ + window_.size()) {
    begin_ = offset;
    window_.resize(std::max(count, std::min(kWindow, size_ - offset)));
    for (std::size_t done = 0; done < window_.size();) {
      const std::size_t got = file_->read_at(offset + done, window_.data() + done, window_.size() - done);
      if (got == 0)
        throw InputError(file_->path() + ": became shorter than byte " + std::to_string(offset + window_.size()) +
                         " while it was read; copy the log and give the copy");
      done += got;
    }
  }
  return {window_.data() + (offset - begin_), count};
}

}  // namespace rubble::robot
