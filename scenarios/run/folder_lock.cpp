#include "scenarios/run/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "base/error.h"

namespace rubble::scenarios {

FolderLock::FolderLock(const std::string& folder, Busy busy)
    : file_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (file_ < 0) return;
  int taken = 0;
  do {
    taken = flock(file_, busy == Busy::Wait ? LOCK_EX : LOCK_EX | LOCK_NB);
  } while (taken != 0 && errno == EINTR);
  if (taken == 0 || errno != EWOULDBLOCK) return;
  ::close(file_);
  throw InputError(folder + ": another rubble is writing into it; wait for it, or give another folder with --out");
}

FolderLock::~FolderLock() {
  if (file_ >= 0) ::close(file_);
}

}  // namespace rubble::scenarios
