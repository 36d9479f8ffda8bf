#pragma once

#include <string>
#include <string_view>

namespace rubble {

/// A file that is written piece by piece beside `path` and takes its place when it is whole; until then, and for good
/// where it never is, the older one stays. A device or pipe is written to at once.
class NewFile {
 public:
  /// Throws RunError, and InputError where `path` is what this process has read.
  explicit NewFile(const std::string& path);
  /// What was not kept is removed.
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Throws RunError, as does keep().
  void put(std::string_view bytes);
  /// It is whole: on the disk before an older one goes, then renamed.
  void keep();

 private:
  [[noreturn]] void fail(int error) const;

  std::string path_;
  std::string part_;    ///< its name until it is kept; empty: there is none to remove
  std::string target_;  ///< a symbolic link stays one
  int file_ = -1;
  bool replaces_ = false;
};

/// Makes a file beside `target` that nobody else made: a link or file that was planted under its name is not followed.
/// Its descriptor, or -1; its name is left in `part`. Until let_be(part) it counts as unfinished.
int create_beside(const std::string& target, std::string& part);
/// It was renamed or removed: remove_unfinished_files() no longer knows `part`.
void let_be(const std::string& part);

/// Removes what this process has not finished, for a signal handler that ends it: safe there.
void remove_unfinished_files() noexcept;

}  // namespace rubble
