#pragma once

#include <string>
#include <string_view>

namespace rubble {

/// The whole file as bytes. Throws InputError in one line: missing, a folder, a pipe or device, not readable, over
/// 256 MB. See InputFile.
std::string read_text_file(const std::string& path);

/// Writes the whole file or leaves the old one: to a new file beside it (on the disk before an older one goes), then
/// renamed. All files that are written at once go through here. Throws RunError, and InputError where `path` is what
/// this process has read.
void write_text_file(const std::string& path, std::string_view text);

/// `folder/name` for a file that the program names itself. A link that was planted there is no wish of the user: throws
/// InputError.
std::string place_in(const std::string& folder, const std::string& name);

/// A new empty file beside `path`, of no foreseeable name, to be renamed to it. Until let_be() it counts as unfinished,
/// see new_file.h. Throws RunError.
std::string new_file_beside(const std::string& path);

}  // namespace rubble
