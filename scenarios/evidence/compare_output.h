#pragma once

#include <string>

#include "scenarios/evidence/compare.h"

namespace rubble::scenarios {

/// A table for the terminal.
std::string to_text(const Comparison& comparison);
/// One line a metric and group, with a header; RFC 4180.
std::string to_csv(const Comparison& comparison);
std::string to_json(const Comparison& comparison);
/// A page of its own, without any reference to another file.
std::string to_html(const Comparison& comparison);
/// A table for documents.
std::string to_markdown(const Comparison& comparison);

}  // namespace rubble::scenarios
