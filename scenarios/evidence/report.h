#pragma once

#include <string>

#include "scenarios/batch/merge.h"
#include "scenarios/batch/sweep_note.h"

namespace rubble::scenarios {

/// One HTML page about a sweep, without any reference to another file but the links to run folders (relative to
/// `page_folder`): a table of configurations, plots, thumbnails of the worst and best maps, failed runs.
std::string report_html(const ResultSet& set, const SweepNote& note, const std::string& page_folder);

/// The same figures as a section of a document: means with 95 % intervals by configuration, then every configuration
/// against the first one.
std::string report_markdown(const ResultSet& set, const SweepNote& note);

}  // namespace rubble::scenarios
