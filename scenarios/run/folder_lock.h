#pragma once

#include <string>

namespace rubble::scenarios {

/// Keeps other commands of rubble out of a folder that two of them would spoil. The system lets it go when the process
/// ends, whatever ends it; where a file system knows no locks there is none.
class FolderLock {
 public:
  enum class Busy { Refuse, Wait };

  /// Throws InputError when another command holds it and is not waited for.
  explicit FolderLock(const std::string& folder, Busy busy = Busy::Refuse);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace rubble::scenarios
