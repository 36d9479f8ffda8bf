#include "base/text/text_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/new_file.h"

namespace rubble {

std::string read_text_file(const std::string& path) { return read_input(path); }

void write_text_file(const std::string& path, std::string_view text) {
  NewFile file(path);
  file.put(text);
  file.keep();
}

std::string place_in(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name;
  std::error_code error;
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(path, error)))
    throw InputError(path +
                     ": is a symbolic link, what is written could go anywhere; remove it or give another folder");
  return path;
}

std::string new_file_beside(const std::string& path) {
  std::string part;
  const int file = create_beside(path, part);
  if (file < 0)
    throw RunError(path + ": cannot be written (" + std::strerror(errno) + "); check the folder and the free space");
  ::close(file);
  return part;
}

}  // namespace rubble
