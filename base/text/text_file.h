#pragma once

#include <string>
#include <string_view>

namespace rubble {

/// The whole file as bytes. Throws InputError in one line: missing, a folder, not readable, over 256 MB.
std::string read_text_file(const std::string& path);

/// Writes the whole file or leaves the old one: to a new file beside it (on the disk before an older one goes), then
/// renamed. All files that are written at once go through here. Throws RunError.
void write_text_file(const std::string& path, std::string_view text);

}  // namespace rubble
