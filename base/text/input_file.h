#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>

namespace rubble {

/// A signal came while a pipe was waited for: exit code 130.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Which pipes a reader waits at.
enum class Pipes {
  None,   ///< its file is opened more than once
  Typed,  ///< /dev/stdin and /dev/fd/N: no file of a foreign folder has such a name
  Named   ///< those in a folder too
};

/// What one reader takes.
struct InputRules {
  std::string thing = "a file";                             ///< that the user should give instead
  std::size_t most = std::size_t{256} << 20;                ///< [bytes]
  std::string too_large = "this is not the file you mean";  ///< the remedy
  Pipes pipes = Pipes::Typed;
};

/// Of maps and pictures.
InputRules image_rules();

/// The one way in for bytes of the user's files: never waits but where a pipe is meant, reads no folder, device or
/// socket, and remembers what was read (see require_not_read). All readers use it; a library that opens files itself
/// gets one that passed here.
class InputFile {
 public:
  /// Throws InputError in one line: missing, a folder, a device, a pipe where none is taken, over rules.most.
  explicit InputFile(const std::string& path, const InputRules& rules = {});
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Up to `size` bytes; 0: the end. Throws InputError (cannot be read), Interrupted.
  std::size_t read(char* to, std::size_t size);
  /// All that is left. Throws InputError when it passes rules.most.
  std::string rest();

  /// Of a file that is no pipe or terminal: what it held when it was opened [bytes].
  std::optional<std::size_t> size() const;
  /// Up to `size` bytes from `offset` on of such a file; read() and rest() go on where they were. 0: the end. Throws
  /// InputError.
  std::size_t read_at(std::size_t offset, char* to, std::size_t size) const;
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail_read() const;

  std::string path_;
  InputRules rules_;
  int file_ = -1;
  std::size_t size_ = 0;  ///< when it was opened
  bool waits_ = false;    ///< a pipe or terminal
};

/// The whole file.
std::string read_input(const std::string& path, const InputRules& rules = {});

/// For what a library opens by its path, or is opened later: a file that may be read; remembered as read.
void require_input(const std::string& path, const InputRules& rules = {});

/// An output never destroys an input. Throws InputError when `path` is, by whatever name or link, a file that this
/// process has read. Files that it wrote itself (see note_written) do not count.
void require_not_read(const std::string& path);
bool was_read(const std::string& path);

/// The file that was just made here under this descriptor is our own.
void note_written(int file);

}  // namespace rubble
