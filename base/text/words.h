#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rubble {

/// `text` on one line: line breaks and other control characters become escapes such as \n, \t, \x1b. So do characters
/// that cannot be seen but change what is (they turn the direction of writing, or hide): a name cannot pose as another.
std::string one_line(std::string_view text);

/// A byte as two digits, "0a".
std::string hex_digits(unsigned char byte);

/// 'text' in quotes for a message, on one line, cut at `limit` bytes.
std::string in_quotes(std::string_view text, std::size_t limit = 60);

/// Whether `text` ends in `end` and has something before it: a file name and its ending.
bool ends_with(std::string_view text, std::string_view end);

/// Changes that turn a into b: insert, delete or replace a letter, swap two neighbours
/// (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// ", did you mean 'slope'?" with the nearest of `candidates` (the first among equals); empty when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c" for a list in a message.
std::string joined(const std::vector<std::string>& words);

}  // namespace rubble
