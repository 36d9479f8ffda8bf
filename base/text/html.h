#pragma once

#include <string>

namespace rubble {

/// Text for the inside of an HTML element or attribute.
std::string escape_html(const std::string& text);

/// RFC 4648, to put bytes into a page.
std::string base64(const std::string& bytes);

/// A whole page with our style sheet, without any reference to another file.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace rubble
