#pragma once
#include <string>
namespace rubble {
std::string sha256_of_text(const std::string& text);
std::string sha256_of_file(const std::string& path);
}  // namespace rubble
