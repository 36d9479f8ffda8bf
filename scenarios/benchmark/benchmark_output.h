#pragma once

#include <string>

#include "scenarios/benchmark/benchmark.h"

namespace rubble::scenarios {

/// A table for the terminal.
std::string to_text(const Benchmark& benchmark);
std::string to_json(const Benchmark& benchmark);
/// A page of its own, without any reference to another file.
std::string to_html(const Benchmark& benchmark);
/// Tables for documents.
std::string to_markdown(const Benchmark& benchmark);

}  // namespace rubble::scenarios
