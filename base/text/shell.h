#pragma once

#include <string>

namespace rubble {

/// `text` as one word of a shell's command line: in single quotes where it has anything but letters, digits and
/// `_ - . / , : = + @ %`.
std::string shell_word(const std::string& text);

}  // namespace rubble
