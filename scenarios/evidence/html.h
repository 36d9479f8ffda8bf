#pragma once

#include <string>

namespace rubble::scenarios {

/// Text for the inside of an HTML element or attribute.
std::string escape_html(const std::string& text);

/// A whole page with our style sheet, without any reference to another file.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace rubble::scenarios
